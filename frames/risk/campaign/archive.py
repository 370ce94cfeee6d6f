"""Results databases as data for others: one archive of zarr, CSV and a README."""

from __future__ import annotations

import tempfile
import warnings
import zipfile
from collections.abc import Mapping
from importlib.metadata import distribution
from pathlib import Path
from typing import TYPE_CHECKING

from frames._provenance import CITATION
from frames.results.storage import csv_of, make_folder, write_whole
from frames.risk._errors import CampaignError
from frames.risk.campaign.designs import UNITS
from frames.risk.campaign.store import PLAN, CampaignStore, open_campaign
from frames.risk.campaign.store_writing import lacking_packages

if TYPE_CHECKING:
    import pandas as pd

_MEANT = {
    "model": "structure, with its devices",
    "parameter_set": "number of the set of parameters",
    "motion": "ground motion, by name; its digest is motion_digest in results.zarr",
    "scale": "factor on the motion, or the intensity [m/s2, m/s] that it is scaled to",
    "outcome": "complete, bearing failure, numerical failure (nothing is known), or not built",
    "status": "how the run ended",
    "message": "why it ended",
    "doubts": "what the check of modelling assumptions marks",
    "seconds_loop": "time of computation",
    "duration computed": "time at which the run ended",
}
"""Columns of the table of runs that are no parameter and no result."""

_KINDS = {"residual": "at the end of the run", "minimum": "smallest of the run"}
"""Results whose names begin so; others are the largest of the run."""

_README = """# {title}

Time histories of structures on seismic isolators: {count}. {files}

Written by {program}: `{command}`. {licence}
Cite: {citation}.
No ground motion is in this archive: `motion` names them, and `motion_digest` tells whether a
record is the one that was run. Histories of runs are not in it.
"""
_PART = """
## {name}

{runs} runs, digest of the results {digest}. Origin: {source}, {date}.

- `{folder}runs.csv`: a row a run. In Python: `pandas.read_csv("{folder}runs.csv")`
- `{folder}results.zarr`: all arrays and units, by zarr or `xarray.open_zarr`
- `{folder}plan.json`: structures, motions and options as digests and numbers
{others}
| column of runs.csv | unit | meaning |
| --- | --- | --- |
{columns}
"""


def archive_campaign(
    stores: str | Path | Mapping[str, str | Path], path: str | Path, *, command: str = ""
) -> Path:
    """Write results databases as one zip archive that other programs read without this package.

    Parameters
    ----------
    stores : str, path, or mapping of str to them
        Folder of a campaign; or several by name, each a folder of the archive.
    path : str or path
        The archive, ``.zip``; an existing one is replaced.
    command : str
        Command that made the results, for the README.

    Returns
    -------
    pathlib.Path
        The archive: README.md with columns, units, digests and licence; of each campaign runs.csv,
        results.zarr, plan.json and the files of its page. The same results give the same bytes.

    Raises
    ------
    CampaignError
        If a campaign is not complete or not as it was written, or the archive is no .zip.
    ImportError
        If zarr is not installed.

    Examples
    --------
    >>> from frames.risk import CampaignError, archive_campaign
    >>> try:
    ...     archive_campaign("nowhere", "runs.zip")
    ... except CampaignError as error:
    ...     print(error)
    nowhere holds no campaign: name the folder that one was run in
    """
    if lacking := lacking_packages("zarr"):
        raise ImportError(lacking)
    target = Path(path)
    if target.suffix != ".zip":
        msg = f"{target} must end in .zip: it is an archive, as {target.with_suffix('.zip').name}"
        raise CampaignError(msg)
    named = dict(stores) if isinstance(stores, Mapping) else {"": stores}
    found = {name: open_campaign(each) for name, each in named.items()}
    with tempfile.TemporaryDirectory() as place:
        root, parts, runs = Path(place), [], 0
        for name, store in found.items():
            digest = store.digest()  # finds that it is whole
            table = _written(store, root / name)
            told = name or target.stem, f"{name}/" if name else "", digest
            parts.append(_part(*told, store, table))
            runs += len(table)
        program = str(next(iter(found.values())).plan()["program"])
        given = {
            "title": target.stem,
            "count": f"{runs} runs",
            "files": f"Campaigns: {', '.join(named)}." if len(named) > 1 else "",
            "program": f"lir-dcfp {program}",
            "command": command or "lir campaign",
            "licence": "Licence: BSD-3-Clause, as LICENSE has it.",
            "citation": CITATION,
        }
        (root / "README.md").write_text(_README.format(**given) + "".join(parts), "utf-8")
        licence = distribution("lir-dcfp").read_text("licenses/LICENSE") or given["licence"]
        (root / "LICENSE").write_text(licence, "utf-8")
        make_folder(target.parent)
        packed = root.with_suffix(".zip")
        try:
            _pack(root, packed)
            write_whole(target, packed.read_bytes())
        finally:
            packed.unlink(missing_ok=True)
    return target


def _written(store: CampaignStore, folder: Path) -> pd.DataFrame:
    # The data of a campaign in a folder.
    folder.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings():  # texts have no type of zarr 3 that all programs share
        warnings.simplefilter("ignore")
        store.results().load().to_zarr(folder / "results.zarr", zarr_format=2, consolidated=True)
    table = store.to_dataframe()
    (folder / "runs.csv").write_text(csv_of(table), "utf-8")
    for file in [store.path / PLAN, *_others(store)]:
        (folder / file.name).write_bytes(file.read_bytes())
    return table


def _others(store: CampaignStore) -> list[Path]:
    # The page of a campaign, and its tables.
    return sorted(store.path.glob("campaign*.*"))


def _part(name: str, folder: str, digest: str, store: CampaignStore, table: pd.DataFrame) -> str:
    units, parameters = table.attrs["units"], list(store.plan()["parameters"])
    rows = []
    for column in map(str, table.columns):
        kind = _KINDS.get(column.split(" ")[0], "largest of the run")
        unit, text = units.get(column, ""), _MEANT.get(column, kind)
        if column in parameters:
            unit, text = UNITS.get(column, ""), "parameter"
        rows.append(f"| {column} | {unit or '-'} | {text} |")
    given = {"source": table.attrs.get("source", ""), "date": table.attrs.get("date_created", "")}
    page = "- other files: the page of the campaign with its input, and its tables\n"
    given["others"] = page if _others(store) else ""
    columns = {"folder": folder, "columns": "\n".join(rows), "digest": digest}
    return _PART.format(name=name, runs=len(table), **given, **columns)


def _pack(root: Path, packed: Path) -> None:
    # Without the times of files, so that the same data have the same bytes.
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(each for each in root.rglob("*") if each.is_file()):
            entry = zipfile.ZipInfo(file.relative_to(root).as_posix())
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, file.read_bytes())
