"""Figures of a model in space: at rest, at an instant of a time history, in its modes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from frames.assembly.assemble import assemble
from frames.plots import plot_choice as pick
from frames.plots import plot_style as ps
from frames.plots.model_geometry import (
    HINGES,
    diaphragm_faces,
    draw_links,
    hinge_places,
    member_lines,
    part_handles,
    shell_corners,
    wall_faces,
)
from frames.recording.recovery import require_own
from frames.results.recorded import require_recorded, require_steps
from frames.statics.modes import modes

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from frames.assembly.system import System
    from frames.model.frame_data import FrameData
    from frames.statics.modes import BearingStiffness

LARGEST = 0.08
"""Default drawn size of the largest displacement over the extent of the model."""

MEMBERS, BEARINGS, SUPPORTS, MASSES, AT_REST = (
    ps.PALETTE[0],
    ps.PALETTE[1],
    "black",
    ps.PALETTE[2],
    "#BBBBBB",
)
FACES = {
    "shells": {"facecolor": MEMBERS, "alpha": 0.15, "edgecolor": MEMBERS, "linewidths": 0.3},
    "walls": {"facecolor": ps.PALETTE[4], "alpha": 0.35, "edgecolor": ps.GREY, "linewidths": 0.3},
    "diaphragms": {"facecolor": ps.PALETTE[5], "alpha": 0.15, "linewidths": 0.0},
}
"""Style of areas, by their name in the legend."""
_PICTURES = 20  # a second, of a film
_NARROW = 0.35  # of the longest side: below, there is room for few numbers along an axis
_MASS_SIZE = 90.0  # pt2, of the largest mass's mark


def model_view(
    model: FrameData,
    data: xr.Dataset | None = None,
    *,
    time: float | None = None,
    factor: float | None = None,
) -> Figure:
    """Draw a model in space, at rest or at an instant of a time history.

    Parameters
    ----------
    model : Frame
        The model.
    data : xarray.Dataset, optional
        Time history; without one the model is drawn undeformed.
    time : float, optional
        Instant [s]; that of the largest displacement of a bearing if None.
    factor : float, optional
        Factor on displacements; None chooses one that shows the largest.

    Returns
    -------
    Figure
        Members, shells, walls of wide columns, diaphragms as far as beams enclose them, springs,
        bearings, supports and masses (by size); links by kind, stops at their gap enlarged as
        displacements are, plastic hinges; with a time history the undeformed model in grey.

    Raises
    ------
    ModelError
        If the time history is not one of this model.
    ValueError
        If the instant is outside of it, or the factor is not positive.

    Examples
    --------
    In the gallery: "A building on nine bearings" (docs/gallery/building/a_model.py).
    """
    system = assemble(model)
    u, title, scale = np.zeros((len(system.node_names), 6)), model.name, 1.0
    if data is not None:
        require_own(model, system, data)
        moved, instant = _at(data, time)
        scale = _scale(system, moved, factor)
        u, title = scale * moved, f"{model.name} at {instant:.3f} s, enlarged {scale:.3g} times"
    figure = ps.new_figure(5.0)
    panel = figure.add_subplot(projection="3d", computed_zorder=False)
    rest = [] if data is None else _draw(panel, model, system, np.zeros_like(u), plain=True)
    drawn = _draw(panel, model, system, u, enlarged=scale) + rest
    frame_of(panel, [system.coordinates, system.coordinates + u[:, :3]])
    _add_legend(figure, model, drawn, title)
    return figure


def model_film(
    model: FrameData,
    data: xr.Dataset,
    *,
    factor: float | None = None,
    start: float | None = None,
    end: float | None = None,
    speed: float = 1.0,
) -> FuncAnimation:
    """Draw a model in space as it moves through a time history.

    Parameters
    ----------
    model : Frame
        The model.
    data : xarray.Dataset
        Time history of the model.
    factor : float, optional
        Factor on displacements; None chooses one that shows the largest.
    start, end : float, optional
        Window of time [s].
    speed : float
        Seconds of the time history a second of the film.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        Film of 20 pictures a second: ``film.save("model.gif", writer="pillow")`` writes it, in a
        notebook ``film.to_jshtml()`` shows it.

    Raises
    ------
    ModelError
        If the time history is not one of this model.
    ValueError
        If nothing is in the window, or a factor is not positive.

    Examples
    --------
    >>> import tempfile
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.plots import model_film
    >>> frame, pulse = example()
    >>> film = model_film(frame, time_history(frame, pulse), end=0.05)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     film.save(f"{folder}/model.gif", writer="pillow")
    """
    system = assemble(model)
    require_own(model, system, data)
    if not speed > 0.0:
        msg = f"speed = {speed:g} must be positive: 1 is the speed of the earthquake"
        raise ValueError(msg)
    data = next(iter(pick.as_systems(data, start, end).values()))
    times = data["time"].to_numpy()
    moments = np.arange(times[0], times[-1] + 1e-9, speed / _PICTURES)
    steps = np.searchsorted(times, moments - 1e-9).clip(max=len(times) - 1)
    every = data["node_displacement"].transpose("time", "node", "dof").to_numpy()
    sizes = np.linalg.norm(every[..., :3], axis=-1).max(axis=1)
    scale = _scale(system, every[int(sizes.argmax())], factor)
    figure = ps.new_figure(5.0)
    panel: Any = figure.add_subplot(projection="3d")
    rest = _draw(panel, model, system, np.zeros(every.shape[1:]), plain=True)
    reach = scale * every[..., :3]
    corners = [system.coordinates + reach.min(axis=0), system.coordinates + reach.max(axis=0)]
    frame_of(panel, corners)
    drawn = _draw(panel, model, system, scale * every[0], enlarged=scale)
    _add_legend(figure, model, drawn + rest, f"{model.name}, enlarged {scale:.3g} times")

    def show(picture: int) -> list[Any]:
        while drawn:
            drawn.pop().remove()
        step = int(steps[picture])
        drawn.extend(_draw(panel, model, system, scale * every[step], enlarged=scale))
        drawn.append(panel.text2D(0.02, 0.02, f"{times[step]:.2f} s", transform=panel.transAxes))
        return drawn

    return FuncAnimation(figure, show, frames=len(steps), interval=1000.0 / _PICTURES)


def mode_shapes(model: FrameData, count: int = 3, bearings: BearingStiffness = "sliding") -> Figure:
    """Draw the first natural modes of a model on its bearings.

    Parameters
    ----------
    model : Frame
        The model.
    count : int
        Number of modes, 1 to 6.
    bearings : {"sliding", "sticking", "fixed"}
        Stiffness of the bearings, as in `frames.modes`.

    Returns
    -------
    Figure
        A panel for each mode with its period and the shares of mass along x, y and z.

    Raises
    ------
    ValueError
        If `count` is above six.
    ModelError
        As for `frames.modes`.

    Examples
    --------
    In the gallery: "Modes with the bearings sliding" (docs/gallery/building/b_modes.py).
    """
    if count > len(ps.COLUMNS) - 1:
        msg = f"count = {count}: draw at most {len(ps.COLUMNS) - 1} modes a page"
        raise ValueError(msg)
    found, system = modes(model, count, bearings), assemble(model)
    columns = ps.COLUMNS[count]
    rows = -(-count // columns)
    figure = ps.new_figure(0.8 + 2.9 * rows)
    for k in range(count):
        panel: Any = figure.add_subplot(rows, columns, k + 1, projection="3d")
        shape = found.shapes[:, :, k]
        u = _scale(system, shape, None) * shape
        rest = _draw(panel, model, system, np.zeros_like(u), plain=True)
        drawn = _draw(panel, model, system, u) + rest
        frame_of(panel, [system.coordinates, system.coordinates + u[:, :3]], bare=True)
        shares = ", ".join(f"{100.0 * share:.0f}" for share in found.mass_ratios[k])
        text = f"mode {k + 1}: {found.periods[k]:.3g} s\nmass x, y, z: {shares} %"
        panel.set_title(text, fontsize=ps.SMALL)
    _add_legend(figure, model, drawn, f"Modes of {model.name}, bearings {bearings}")
    return figure


def _at(data: xr.Dataset, time: float | None) -> tuple[FloatArray, float]:
    # Displacements (n_nodes, 6) at an instant, and the instant that was recorded.
    if time is None:
        require_steps(data, "model_view without a time")
        require_recorded(data, "model_view without a time", "bearing_displacement")
        u = np.linalg.norm(data["bearing_displacement"].to_numpy()[..., :2], axis=-1)
        step = int(u.max(axis=1).argmax())
    else:
        step = pick.step_at(data, time)
    return data["node_displacement"].to_numpy()[step], float(data["time"][step])


def _scale(system: System, u: FloatArray, factor: float | None) -> float:
    if factor is not None:
        if not factor > 0.0:
            msg = f"factor = {factor:g} must be positive: 1 draws displacements as they are"
            raise ValueError(msg)
        return factor
    largest = float(np.linalg.norm(u[:, :3], axis=1).max())
    extent = float(np.linalg.norm(np.ptp(system.coordinates, axis=0)))
    return LARGEST * extent / largest if largest > 0.0 else 1.0


def _draw(
    panel: Any,
    model: FrameData,
    system: System,
    u: FloatArray,
    *,
    plain: bool = False,
    enlarged: float = 1.0,
) -> list[Any]:
    # The whole model: the panel's own frame would cut parts of the view.
    drawn = _parts(panel, model, system, u, plain=plain)
    if not plain:
        drawn += draw_links(panel, model, system, system.coordinates + u[:, :3], enlarged)
    for artist in drawn:
        artist.set_clip_on(False)
        artist.set_in_layout(False)
    return drawn


def _parts(
    panel: Any, model: FrameData, system: System, u: FloatArray, *, plain: bool = False
) -> list[Any]:
    # The parts of the model at enlarged displacements; returns the drawn artists.
    place = system.coordinates + u[:, :3]
    index = {name: k for k, name in enumerate(system.node_names)}
    lines = member_lines(system.members, system.coordinates, u)
    colour = AT_REST if plain else MEMBERS
    drawn = []
    elements = [pair for part in model.superelements.values() for pair in part.elements.nodes]
    every = [*lines, *(place[[index[one] for one in pair]] for pair in elements)]
    if every:
        look = (
            {"linewidths": 0.7, "label": "at rest"}
            if plain
            else {"linewidths": 1.2, "label": "members"}
        )
        drawn.append(panel.add_collection3d(Line3DCollection(every, colors=colour, **look)))
    zones = [
        (place[node], lines[k, (0, -1)[end]])
        for k, nodes in enumerate(system.members.nodes)
        for end, node in enumerate(nodes)
        if system.members.offsets[k, end].any()
    ]
    if zones:
        look = {"linewidths": 1.5} if plain else {"linewidths": 3.5, "label": "rigid end zones"}
        stiff = Line3DCollection(zones, colors=colour, capstyle="butt", **look)
        drawn.append(panel.add_collection3d(stiff))
    look = {"linewidth": 0.8, "linestyle": ":", "label": None if plain else "springs"}
    for spring in model.springs.values():
        ends = place[[index[spring.i], index[spring.j]]]
        drawn += panel.plot(*ends.T, color=colour, **look)
    if plain:
        return drawn
    areas = {
        "shells": shell_corners(model, system.node_names),
        "walls": [[index[node] for node in face] for face in wall_faces(model)],
        "diaphragms": [[index[node] for node in face] for face in diaphragm_faces(model)],
    }
    for label, faces in areas.items():
        if faces:
            corners = Poly3DCollection([place[f] for f in faces], label=label, **FACES[label])
            drawn.append(panel.add_collection3d(corners))
    released = [
        lines[k, (0, -1)[end]] + 0.08 * (lines[k, (-1, 0)[end]] - lines[k, (0, -1)[end]])
        for k, member in enumerate(model.members.values())
        for end in (0, 1)
        if set(member.releases[end]) & {"My", "Mz"}
    ]
    dots: dict[str, Any] = {"linestyle": "", "marker": "o"}
    if released:
        look = {"color": MEMBERS, "markersize": 4.0, "fillstyle": "none", "label": "releases"}
        drawn += panel.plot(*np.array(released).T, **dots, **look)
    for _, i, j, _ in system.bearings:
        ends = place[[i, j]]
        look = {"color": BEARINGS, "zorder": 5}  # above the masses over them
        drawn += panel.plot(*ends.T, linewidth=3.0, solid_capstyle="butt", **look)
        drawn += panel.plot(*ends[1:].T, markersize=4.5, label="bearings", **dots, **look)
    if model.hinges:
        drawn += panel.plot(*hinge_places(lines, system, model.hinges)[1].T, **HINGES)
    fixed = [index[name] for name, dofs in model.fixed_dofs.items() if {"ux", "uy", "uz"} & dofs]
    look = {"color": SUPPORTS, "marker": "^", "markersize": 5.0, "label": "supports"}
    drawn += panel.plot(*place[fixed].T, linestyle="", **look)
    mass = system.node_mass[:, :3].max(axis=1)
    if (heavy := mass > 0.0).any():
        look = {"s": _MASS_SIZE * mass[heavy] / mass.max(), "c": MASSES, "label": "masses"}
        look |= {"alpha": 0.6, "linewidths": 0.0, "depthshade": False}
        drawn.append(panel.scatter(*place[heavy].T, **look))
    return drawn


def frame_of(panel: Any, points: list[FloatArray], *, bare: bool = False) -> None:
    """Set the axes of a panel in space to equal scales around all points (n, 3)."""
    every = np.concatenate(points)
    low, high = every.min(axis=0), every.max(axis=0)
    span = np.maximum(high - low, 0.15 * float((high - low).max()) or 1.0)
    middle = 0.5 * (low + high)
    for name, centre, width in zip("xyz", middle, span, strict=True):
        getattr(panel, f"set_{name}lim")(centre - 0.55 * width, centre + 0.55 * width)
        if width < _NARROW * span.max():
            getattr(panel, f"{name}axis").set_major_locator(MaxNLocator(2))
    panel.set_box_aspect(span, zoom=1.12)
    panel.view_init(elev=18.0, azim=-62.0)
    if bare:
        panel.set_axis_off()
        return
    panel.tick_params(labelsize=ps.SMALL)
    for name in "xyz":
        getattr(panel, f"set_{name}label")(f"{name} [m]", fontsize=ps.LABEL)


def _add_legend(figure: Figure, model: FrameData, drawn: list[Any], title: str) -> None:
    # Each kind of part once, as it is drawn.
    kinds = {str(artist.get_label()): artist for artist in drawn}
    handles = [artist for label, artist in kinds.items() if label[0] != "_"]
    ps.add_legend(figure, [*handles, *part_handles(model)], columns=5, title=title)
