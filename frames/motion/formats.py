"""The formats of networks as a table: how to recognise a file, and the items of its header."""

from __future__ import annotations

from typing import NamedTuple

_F = r"([-+]?\d*\.?\d+(?:[Ee][-+]?\d+)?)"


class Format(NamedTuple):
    """A format of records; patterns are looked for in each component's header, line by line."""

    name: str  # networks that write it
    mark: str  # pattern of the first lines of a file, by which it is recognised
    first: str | int  # pattern of the last line of a header, or its number of lines
    # pattern of a line with which the next component begins; empty if a file has one header
    parts: str = ""
    after: int = 0  # lines between the one that `first` finds and the numbers
    # pattern of the number of samples; of the duration [s], if it is given instead or besides
    size: str = ""
    length: str = ""
    step: str = ""  # pattern of the time step [s]; of the samples a second
    rate: str = ""
    # pattern of the unit of the numbers; two groups are acceleration and counts [gal]
    unit: str = ""
    fixed_unit: str = ""  # the unit of the format, if its header names none
    # pattern of the direction; of a table of several components, of the titles of its columns
    direction: str = ""
    # pattern of the largest acceleration that the header names; its unit, if that is not the
    # second group of the pattern
    peak: str = ""
    peak_unit: str = ""
    # "rows", "pairs" (of time and value), "columns", or "rows or pairs" by their number
    order: str = "rows"
    # characters of a number if numbers touch; 0 if the header has it or they do not touch
    width: int = 0
    mean: bool = False  # true if the mean is subtracted: raw counts about an offset
    whole: bool = True  # whether the numbers run to the end of the file, or of the part


_POINTS = r"^\s*(\d+)\s+(?:points of accel|accelerogram points|acceleration pts|raw accel)"

FORMATS = (
    Format(
        name="K-NET, KiK-net",
        mark=r"\AOrigin Time\s",
        first=r"^Memo\.",
        length=rf"^Duration Time\s*\(s\)\s+{_F}",
        rate=rf"^Sampling Freq\s*\(Hz\)\s+{_F}",
        unit=rf"^Scale Factor\s+{_F}\s*\(gal\)\s*/\s*{_F}",
        direction=r"^Dir\.\s+(\S+)",
        peak=rf"^Max\. Acc\. \(gal\)\s+{_F}",
        peak_unit="gal",
        mean=True,
    ),
    Format(
        name="COSMOS",
        mark=r"^\s*\d+ Real-header values follow",
        first=_POINTS,
        parts=r"^\s*(?:/&|End-of-data)",
        size=_POINTS,
        length=rf"acceleration pts, approx\s+{_F}\s*sec",
        unit=r"units\s*=\s*([a-z0-9/]+)",
        direction=r"^Sta Cha\S*\s*\S*:\s*(.*?)\s*\(Rcrdr",
        whole=False,
    ),
    Format(
        name="CSMIP (CGS, SCSN, NSMP), volumes 1 and 2",
        mark=_POINTS,
        first=_POINTS,
        parts=r"^/&",
        size=_POINTS,
        step=rf"equally[- ]spaced at\s+{_F}\s*sec",
        rate=rf"points at\s+{_F}\s*pts/sec",
        unit=r"(?:units\s*:|units of|sec, in)\s*([a-z0-9/]+)",
        direction=r"^Chan\s+\d+:\s*(.*?)\s*(?:\(Sta Chn.*)?$",
        peak=rf"^(?:Peak acceleration|Units of .*\bMax)\s*=\s*{_F}\s*([a-z]+)",
        width=10,
        whole=False,
    ),
    Format(
        name="volume 1 (RENADIC, USC, BHRC, CSMIP before 1999)",
        mark=r"^UNITS (?:OF UNCOR ACCEL )?ARE SEC(?:ONDS)? AND G/10",
        first=27,
        parts=r"^\s*(?:/&|\* VOL1DS FILE|FILE\s+\d+ OF UNCORRECTED)",
        size=r"^NO\. OF POINTS =\s*(\d+)",
        length=rf"(?:RECORD LENGTH|DURATION)\s*=\s*{_F}",
        fixed_unit="g/10",
        direction=r"^(?:CHAN\s+\d+:|COMP)\s*(.*?)\s*(?:\(STA CHN.*|\d+\s*)?$",
        peak=rf"\bMAX\s*=\s*{_F}\s*G",
        peak_unit="g",
        order="rows or pairs",
        width=7,
    ),
    Format(
        name="SMC (USGS)",
        mark=r"\A[12] (?:UN)?CORRECTED ACCELEROGRAM",
        first=27,
        fixed_unit="cm/s2",
        direction=r"component\s*=\s*(\S+)",
        peak=rf"\bpk(?: acc)?\s*=\s*{_F}",
        peak_unit="cm/s2",
        width=10,
    ),
    Format(
        name="GeoNet, volumes 1 and 2",
        mark=r"\A(?:Unc|C)orrected accelerogram .*GNS Science",
        first=26,
        parts=r"^(?:Unc|C)orrected accelerogram ",
        size=r"^Number of points\s+(\d+)",
        step=rf"(?:at intervals of|corrected data at)\s+{_F}\s*s",
        unit=r"^Acceleration:\s+peak\s+\S+\s+(\S+)",
        direction=r"^Component\s+(\S+)",
        peak=rf"^Acceleration:\s+peak\s+{_F}",
        peak_unit="mm/s2",
        width=8,
        whole=False,
    ),
    Format(
        name="ESM, ITACA, AFAD (DYNA)",
        mark=r"\AEVENT_NAME:",
        first=r"^USER5:",
        size=r"^NDATA:\s*(\d+)",
        step=rf"^SAMPLING_INTERVAL_S:\s*{_F}",
        unit=r"^UNITS:\s*(\S+)",
        direction=r"^STREAM:\s*(\S+)",
        peak=rf"^PGA_CM/S\^2:\s*{_F}",
        peak_unit="cm/s2",
    ),
    Format(
        name="AFAD before 2020 (NSMN)",
        mark=r"\ASTRONG GROUND MOTION RECORDS OF TURKIYE",
        first=r"^\s*N-S\s+E-W\s+U-D",
        size=r"^NUMBER OF DATA\s*:\s*(\d+)",
        step=rf"^SAMPLING INTERVAL \(sec\)\s*:\s*{_F}",
        fixed_unit="gal",
        direction=r"^\s*(N-S\s+E-W\s+U-D)",
        order="columns",
    ),
    Format(
        name="UNAM, standard of Mexico 2.0",
        mark=r"^ARCHIVO ESTANDAR DE ACELERACION",
        first=r"^\s*CANAL-1",
        after=2,
        size=r"^NUM\. TOTAL DE MUESTRAS, C1-C6\s*:\s*/(\d+)",
        step=rf"^INTERVALO DE MUESTREO, C1-C6 \(s\)\s*:\s*/{_F}",
        unit=r"^UNIDADES DE LOS DATOS\s*:\s*(\w+)",
        direction=r"^ORIENTACION C1-C6 \(rumbo;orientacion\)\s*:\s*/(.*)$",
        order="columns",
        width=10,
    ),
    Format(
        name="CWA, CWB (Taiwan)",
        mark=r"^#DataSequence:",
        first=r"^#Data:",
        length=rf"^#RecordLength\(sec\):\s*{_F}",
        rate=rf"^#SampleRate\(Hz\):\s*{_F}",
        unit=r"^#AmplitudeUnit:\s*(\w+)",
        direction=r"^#DataSequence:\s*(.*)$",
        order="columns",
        width=10,
    ),
)
"""Formats that are read by name, besides PEER AT2."""
