"""Figures of results: loops, orbits, histories, profiles over the height, energies, sections.

And of models in space: at rest, at an instant, in their modes; of design spectra and motions; of
fragility and risk.

Each function has as argument one Dataset of `frames.time_history`, or several by name for
comparison. It returns a matplotlib Figure of the width of a page, which a notebook shows as a
picture; it draws on no display and keeps no state. ``start`` and ``end`` [s] show a part of the
time. Save a figure with ``figure.savefig("loops.png", dpi=150)``. Colours follow the order of the
systems, so they agree between figures of the same systems.
"""

from frames.plots.bearing_dimensions import bearing_dimensions as bearing_dimensions
from frames.plots.bearing_drawing import bearing_sections as bearing_sections
from frames.plots.plot_choice import worst_bearing as worst_bearing
from frames.plots.plot_histories import QUANTITIES as QUANTITIES
from frames.plots.plot_histories import bearing_plan as bearing_plan
from frames.plots.plot_histories import histories as histories
from frames.plots.plot_loops import hysteresis as hysteresis
from frames.plots.plot_loops import orbits as orbits
from frames.plots.plot_model import mode_shapes as mode_shapes
from frames.plots.plot_model import model_film as model_film
from frames.plots.plot_model import model_view as model_view
from frames.plots.plot_parts import hinge_map as hinge_map
from frames.plots.plot_parts import link_loops as link_loops
from frames.plots.plot_summaries import energy as energy
from frames.plots.plot_summaries import floor_spectra as floor_spectra
from frames.plots.plot_summaries import storey_profiles as storey_profiles
from lir_element import _lazy

__all__ = _lazy.listed(__file__)
