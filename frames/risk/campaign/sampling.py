"""Samples of parameters: full grid, Latin hypercube and Sobol' points, the same for one seed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeGuard

import numpy as np

from frames.risk._errors import CampaignError
from frames.risk.fragility.sobol import saltelli_sets
from lir_element.argument_checks import as_number, require_type

if TYPE_CHECKING:
    from frames._types import FloatArray


class Distribution(Protocol):
    """Distribution of a parameter: a frozen distribution of `scipy.stats`."""

    def ppf(self, q: FloatArray, /) -> FloatArray:
        """Return the quantiles of the shares `q`."""
        ...


Choice = Sequence[float] | Distribution
"""Values of a parameter, or its distribution."""


@dataclass(frozen=True, eq=False)
class ParameterSample:
    """Sets of parameters.

    Parameters
    ----------
    names : tuple of str, (p,)
        The parameters.
    values : ndarray, (n, p)
        A row a set.
    origin : str
        Method and seed of the sample; kept in a campaign's plan, not compared.

    Raises
    ------
    CampaignError
        If a name cannot be one, sizes do not fit, or a value is not a number.

    Examples
    --------
    >>> from frames.risk import full_grid
    >>> sample = full_grid({"radius": [1.5, 2.0], "friction": [0.04, 0.06]})
    >>> sample.names, sample.values.shape
    (('radius', 'friction'), (4, 2))
    """

    names: tuple[str, ...]
    values: FloatArray
    origin: str = ""

    def __post_init__(self) -> None:
        values = np.array(self.values, dtype=np.float64)
        object.__setattr__(self, "names", tuple(self.names))
        if values.ndim != 2 or values.shape[1] != len(self.names) or not len(values):
            msg = (
                f"sample: values of shape {values.shape} for {len(self.names)} names: give an "
                "array (sets, parameters) with at least one set"
            )
            raise CampaignError(msg)
        if np.isnan(values).any():
            k, n = np.argwhere(np.isnan(values))[0]
            msg = f"sample: {self.names[n]} of set {k} is no number: give one for each"
            raise CampaignError(msg)
        for name in self.names:
            if not name.isidentifier() or self.names.count(name) > 1:
                msg = f'sample: "{name}" must be a name of letters, digits and _, once: rename it'
                raise CampaignError(msg)
        values.flags.writeable = False
        object.__setattr__(self, "values", values)

    def __len__(self) -> int:
        """Return the number of sets."""
        return len(self.values)

    def __getitem__(self, k: int) -> dict[str, float]:
        """Return a set by name."""
        return dict(zip(self.names, self.values[k].tolist(), strict=True))


def full_grid(parameters: Mapping[str, Sequence[float]]) -> ParameterSample:
    """Return all combinations of values.

    Parameters
    ----------
    parameters : mapping of str to sequence of float
        Values of each parameter, SI; ``math.inf`` of an interface friction fuses the sliders.

    Returns
    -------
    ParameterSample
        The last parameter changes first.

    Raises
    ------
    CampaignError
        If a parameter has a distribution or no values.

    Examples
    --------
    >>> full_grid({"radius": [1.5, 2.0], "friction": [0.04, 0.06]}).values.tolist()
    [[1.5, 0.04], [1.5, 0.06], [2.0, 0.04], [2.0, 0.06]]
    """
    given = _checked(parameters)
    for name, choice in given.items():
        if _is_distribution(choice):
            msg = f"{name} has a distribution: a grid needs its values, such as [0.04, 0.06]"
            raise CampaignError(msg)
    rows = list(itertools.product(*given.values()))  # type: ignore[arg-type]  # sequences all
    return ParameterSample(tuple(given), np.array(rows, dtype=np.float64), "full grid")


def latin_hypercube(
    parameters: Mapping[str, Choice], size: int, *, seed: int = 0
) -> ParameterSample:
    """Return a Latin hypercube: of each parameter one set in each of `size` equal shares.

    Parameters
    ----------
    parameters : mapping of str to distribution or sequence of float
        Distributions of `scipy.stats` such as ``uniform(0.04, 0.03)``; the values of a sequence are
        equally likely.
    size : int
        Number of sets.
    seed : int
        The same seed gives the same sets.

    Returns
    -------
    ParameterSample
        The sets.

    Raises
    ------
    CampaignError
        If size, seed or a parameter cannot be.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> sample = latin_hypercube({"friction": uniform(0.04, 0.04)}, 4, seed=1)
    >>> sorted(int((f - 0.04) / 0.01) for f in sample.values[:, 0])
    [0, 1, 2, 3]
    """
    from scipy.stats import qmc  # half a second

    given, size, seed = _checked(parameters), whole("size", size, 1), whole("seed", seed, 0)
    shares = qmc.LatinHypercube(len(given), rng=np.random.default_rng(seed)).random(size)
    return _at(given, shares, f"Latin hypercube, seed {seed}")


def sobol_sample(parameters: Mapping[str, Choice], size: int, *, seed: int = 0) -> ParameterSample:
    """Return scrambled Sobol' points, which fill space evenly; arguments as `latin_hypercube`.

    Parameters
    ----------
    parameters : mapping of str to distribution or sequence of float
        As for `latin_hypercube`.
    size : int
        Number of sets, a power of 2: others lose the balance of the points.
    seed : int
        Seed of the scrambling.

    Returns
    -------
    ParameterSample
        The sets.

    Raises
    ------
    CampaignError
        If size, seed or a parameter cannot be.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> from frames.risk import sobol_sample
    >>> sample = sobol_sample({"friction": uniform(0.04, 0.04)}, 4, seed=1)
    >>> sorted(int((f - 0.04) / 0.01) for f in sample.values[:, 0])
    [0, 1, 2, 3]
    """
    from scipy.stats import qmc

    given, size, seed = _checked(parameters), whole("size", size, 1), whole("seed", seed, 0)
    if size & (size - 1):
        below = 2 ** (size.bit_length() - 1)
        msg = f"size = {size} of Sobol' points must be a power of 2: {below} or {2 * below}"
        raise CampaignError(msg)
    points = qmc.Sobol(len(given), rng=np.random.default_rng(seed))
    shares = points.random_base2(size.bit_length() - 1)
    return _at(given, shares, f"Sobol' points, seed {seed}")


def saltelli_sample(
    distributions: Mapping[str, Distribution], samples: int, *, seed: int = 1
) -> ParameterSample:
    """Return the sets of parameters for `sobol_indices`, for a campaign.

    Parameters
    ----------
    distributions : mapping of str to distribution
        Independent distributions of the parameters.
    samples : int
        Samples n, a power of 2.
    seed : int
        Seed, the same as that of `sobol_indices`.

    Returns
    -------
    ParameterSample
        n (parameters + 2) sets: a sample A, a sample B, then A with one parameter of B after the
        other.

    Raises
    ------
    FragilityError
        If an argument is out of its bounds.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> from frames.risk import saltelli_sample, sobol_indices
    >>> inputs = {"radius": uniform(1.0, 1.0), "friction": uniform(0.04, 0.04)}
    >>> sample = saltelli_sample(inputs, 1024)
    >>> sample.values.shape
    (4096, 2)
    >>> results = sample.values @ [1.0, 2.0]  # one a set, as a campaign gives them
    >>> sobol_indices(results, inputs, samples=1024).table["first"].idxmax()
    'radius'
    """
    sets = saltelli_sets(distributions, samples, seed)
    values = np.array([list(each.values()) for each in sets])
    return ParameterSample(tuple(distributions), values, f"Saltelli's sets, seed {seed}")


def _at(parameters: Mapping[str, Choice], shares: FloatArray, origin: str) -> ParameterSample:
    values = np.empty_like(shares)
    for k, choice in enumerate(parameters.values()):
        if _is_distribution(choice):
            values[:, k] = choice.ppf(shares[:, k])
        else:
            each = np.array(choice, dtype=np.float64)
            values[:, k] = each[(shares[:, k] * len(each)).astype(int)]
    return ParameterSample(tuple(parameters), values, origin)


def _checked(parameters: object) -> dict[str, Choice]:
    require_type("parameters", parameters, Mapping, "a mapping of names to values")
    found: dict[str, Choice] = {}
    for name, choice in parameters.items():  # type: ignore[attr-defined]  # a mapping
        if _is_distribution(choice):
            found[name] = choice
            continue
        if isinstance(choice, str) or not hasattr(choice, "__iter__"):
            msg = f"{name} = {choice!r}: give values, [0.04, 0.06], or scipy.stats.uniform(a, b)"
            raise CampaignError(msg)
        found[name] = [as_number(name, value) for value in choice]
        if not found[name]:
            msg = f"{name} has no values: give one at least"
            raise CampaignError(msg)
    if not found:
        msg = "parameters is empty: name one at least, or leave the sample out"
        raise CampaignError(msg)
    return found


def _is_distribution(choice: object) -> TypeGuard[Distribution]:
    return hasattr(choice, "ppf")


def whole(name: str, value: object, least: int) -> int:
    """Return `value` if it is a whole number of at least `least`, or raise a CampaignError."""
    number = as_number(name, value)
    if not math.isfinite(number) or number != int(number) or number < least:
        msg = f"{name} = {value!r} must be a whole number of at least {least}"
        raise CampaignError(msg)
    return int(number)
