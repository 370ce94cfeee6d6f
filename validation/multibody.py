"""One bearing as a model of the multibody program Exudyn: rigid bodies, contacts and friction.

Nothing of that model is shared with the kernels of the element. Bodies, the contacts of spheres in hollow
spheres, Coulomb's friction, rotations and integration in time are those of Exudyn (1.13). What is
added are the geometry, and the coefficient of friction at the sliding speed, set once a step.

Each face has points on rings of equal area. A point lies in a hollow sphere: the dish of radius R,
for the plane one of 10 km. A rim is a hollow sphere of the radius at which it is met, about a
centre at the height of the slider's vertex there. Two sliders and the top plate move; the plate
stays level. The ground's acceleration acts on all bodies, in axes that move with the bottom plate.
"""

from __future__ import annotations

import math
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames import Frame, Section
from lir_element.exudyn import ExudynBearing, after_step

if TYPE_CHECKING:
    from frames import GroundMotion
    from frames._types import FloatArray
    from lir_element import LIRBearing
    from lir_element.device.features import Level

GRAVITY = 9.80665
PLANE = 1e4  # m: radius of the hollow sphere that stands for the plane
POINT = 1e-6  # m: radius of the sphere that stands for a contact point
DAMPING_AT_INFINITY = 0.2  # spectral radius of the generalised-alpha method
RECORD_STEP = 1e-3  # s


class Options(NamedTuple):
    """How a run is made."""

    step: float = 2e-4
    """Of time [s]."""
    zone: float = 1e-3
    """Sliding speed below which friction is proportional to it [m/s]."""
    rings: int = 2
    """Of contact points a face."""
    each: int = 8
    """Points a ring."""
    tolerance: float = 1e-4
    """Of Newton's method, relative."""


DEFAULT = Options()


class History(NamedTuple):
    """What comes out, by instant."""

    time: FloatArray
    displacement: FloatArray
    """Of the top plate, along x [m]."""
    slip: FloatArray
    """Of the top slider on the bottom one [m]."""
    force: FloatArray
    """Lateral force on the bearing along x, positive with the displacement [N]."""
    axial: FloatArray
    """Axial force on the top plate [N]."""
    rim: FloatArray
    """Larger force of both rims [N]."""


def plan(radius: float, rings: int, each: int) -> list[tuple[float, float]]:
    """Return points on the circles that halve rings of equal area."""
    points = []
    for k in range(rings):
        r = radius * math.sqrt((k + 0.5) / rings)
        for n in range(each):
            angle = 2.0 * math.pi * (n + 0.5 * (k % 2)) / each
            points.append((r * math.cos(angle), r * math.sin(angle)))
    return points


class _Model:
    # The system of Exudyn, with the numbers of its markers and contacts.

    def __init__(
        self, bearing: LIRBearing, mass: float, motion: GroundMotion, options: Options
    ) -> None:
        exudyn, items = (import_module(name) for name in ("exudyn", "exudyn.itemInterface"))

        self.exudyn, self.items, self.options = exudyn, items, options
        self.container = exudyn.SystemContainer()
        self.system = self.container.AddSystem()
        self.bearing = bearing
        given = bearing.resolved()
        self.stiffness, self.damping = (
            3.0 * given[f"axial_{name}"] for name in ("stiffness", "damping")
        )
        height, radius = bearing.slider_height, bearing.slider_radius
        half = bearing.slider_density * math.pi * radius**2 * 0.5 * height
        across = half * (radius**2 / 4.0 + (0.5 * height) ** 2 / 12.0)
        inertias = ((across, across, 0.5 * half * radius**2),) * 2 + ((1e5, 1e5, 1e5),)
        self.heights = (0.25 * height, 0.75 * height, height)
        self.masses = (half, half, mass)
        shortened = mass * GRAVITY / self.stiffness
        self.ground = self.system.AddObject(items.ObjectGround())
        self.bodies = [
            self._body(self.masses[k], inertias[k], self.heights[k], -(k + 1) * shortened)
            for k in range(3)
        ]
        self._faces()
        self._rims(given["rim_stiffness"], given["rim_damping"])
        self._loads(motion)
        self.rows: list[tuple[float, ...]] = []

    def _body(self, mass: float, inertia: tuple[float, ...], z: float, down: float) -> Any:
        node = self.system.AddNode(
            self.items.NodeRigidBodyRotVecLG(
                referenceCoordinates=[0, 0, z, 0, 0, 0], initialCoordinates=[0, 0, down, 0, 0, 0]
            )
        )
        inertia_terms = [*inertia, 0.0, 0.0, 0.0]
        return self.system.AddObject(
            self.items.ObjectRigidBody(mass=mass, inertia=inertia_terms, nodeNumber=node)
        )

    def _marker(self, body: Any, x: float, y: float, z: float) -> Any:
        return self.system.AddMarker(
            self.items.MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, z])
        )

    def _contact(self, point: Any, centre: Any, radius: float, gap: float, **law: float) -> Any:
        node = self.system.AddNode(
            self.items.NodeGenericData(initialCoordinates=[gap, 0, 0, 0], numberOfDataCoordinates=4)
        )
        return self.system.AddObject(
            self.items.ObjectContactSphereSphere(
                markerNumbers=[point, centre],
                nodeNumber=node,
                spheresRadii=[POINT, radius + POINT],
                isHollowSphere1=True,
                frictionProportionalZone=self.options.zone,
                **law,
            )
        )

    def _faces(self) -> None:
        bottom, top, plate = self.bodies
        low, up, _ = self.heights
        height = self.bearing.slider_height
        first, second = self.bearing.radii
        dishes = self._marker(self.ground, 0, 0, first), self._marker(plate, 0, 0, -second)
        plane = self._marker(bottom, 0, 0, 0.5 * height - low + PLANE)
        points = plan(self.bearing.slider_radius, self.options.rings, self.options.each)
        law = {
            "contactStiffness": self.stiffness / len(points),
            "contactDamping": self.damping / len(points),
        }
        self.surfaces: tuple[list[Any], list[Any]] = ([], [])
        for x, y in points:
            rise = [r - math.sqrt(r**2 - x**2 - y**2) for r in (first, second)]
            lower = self._marker(bottom, x, y, rise[0] - low)
            upper = self._marker(top, x, y, height - rise[1] - up)
            pressed = -self.masses[2] * GRAVITY / self.stiffness
            for k, point in enumerate((lower, upper)):
                mu = self.bearing.frictions[k].f_min
                self.surfaces[k].append(
                    self._contact(
                        point,
                        dishes[k],
                        self.bearing.radii[k],
                        pressed,
                        dynamicFriction=mu,
                        **law,
                    )
                )
            between = self._marker(top, x, y, 0.5 * height - up)
            mu = self.bearing.interface_friction
            self._contact(between, plane, PLANE, pressed, dynamicFriction=mu, **law)

    def _rims(self, stiffness: float, damping: float) -> None:
        bottom, top, plate = self.bodies
        height = self.bearing.slider_height
        self.vertices = (
            self._marker(bottom, 0, 0, -self.heights[0]),
            self._marker(top, 0, 0, height - self.heights[1]),
        )
        self.plate = self._marker(plate, 0, 0, 0)
        self.rims = []
        for k, way in enumerate(self.bearing.rim_displacement):
            sphere = self.bearing.radii[k]
            rise = sphere - math.sqrt(sphere**2 - way**2)
            centre = self._marker((self.ground, plate)[k], 0, 0, (rise, -rise)[k])
            self.rims.append(
                self._contact(
                    self.vertices[k],
                    centre,
                    way,
                    way,
                    contactStiffness=stiffness,
                    contactDamping=damping,
                )
            )
        level = self._marker(self.ground, 0, 0, 0)
        self.system.AddObject(
            self.items.ObjectJointGeneric(
                markerNumbers=[level, self.plate], constrainedAxes=[0, 0, 0, 1, 1, 1]
            )
        )

    def _loads(self, motion: GroundMotion) -> None:
        pull = np.asarray(motion.x)
        times = motion.dt * np.arange(len(pull))
        for body, mass in zip(self.bodies, self.masses, strict=True):

            def load(_system: Any, t: float, _: Any, mass: float = mass) -> list[float]:
                return [-mass * float(np.interp(t, times, pull)), 0.0, -mass * GRAVITY]

            self.system.AddLoad(
                self.items.LoadForceVector(
                    markerNumber=self._marker(body, 0, 0, 0),
                    loadVector=[0.0, 0.0, -mass * GRAVITY],
                    loadVectorUserFunction=load,
                )
            )

    def after_step(self, system: Any, time: float) -> bool:
        """Set the coefficients of friction at the sliding speeds, and record."""
        kinds = self.exudyn.OutputVariableType
        seen = (*self.vertices, self.plate)
        speeds = [np.array(system.GetMarkerOutput(m, kinds.Velocity)) for m in seen]
        for k, sliding in enumerate((speeds[0], speeds[1] - speeds[2])):
            law: Any = self.bearing.frictions[k]
            lower = (law.f_max - law.f_min) * math.exp(-law.rate * math.hypot(*sliding[:2]))
            for contact in self.surfaces[k]:
                system.SetObjectParameter(contact, "dynamicFriction", law.f_max - lower)
        if time < RECORD_STEP * len(self.rows) - 1e-9:
            return True
        plate = system.GetMarkerOutput(self.plate, kinds.Position)
        sliders = [
            np.array(system.GetObjectOutputBody(body, kinds.Position, [0.0, 0.0, 0.0]))
            for body in self.bodies[:2]
        ]
        axes = system.GetObjectOutputBody(self.bodies[0], kinds.RotationMatrix, [0.0, 0.0, 0.0])
        slip = np.array(axes).reshape(3, 3).T @ (sliders[1] - sliders[0])
        forces = [
            np.array(system.GetObjectOutput(contact, kinds.Force))
            for contact in (*self.surfaces[1], self.rims[1])
        ]
        total = np.sum(forces, axis=0)
        rims = [
            float(np.linalg.norm(system.GetObjectOutput(rim, kinds.Force))) for rim in self.rims
        ]
        self.rows.append((time, plate[0], slip[0], total[0], abs(total[2]), max(rims)))
        return True

    def run(self, duration: float) -> None:
        """Integrate; Exudyn halves the step where Newton's method does not converge."""
        self.system.SetPostStepUserFunction(self.after_step)
        self.system.Assemble()
        settings = self.exudyn.SimulationSettings()
        settings.linearSolverType = self.exudyn.LinearSolverType.EXUdense
        settings.solutionSettings.writeSolutionToFile = False
        way = settings.timeIntegration
        way.endTime, way.numberOfSteps = duration, round(duration / self.options.step)
        way.generalizedAlpha.spectralRadius = DAMPING_AT_INFINITY
        way.newton.useModifiedNewton = True
        way.newton.relativeTolerance = self.options.tolerance
        way.newton.absoluteTolerance = 1e-3  # N
        way.discontinuous.maxIterations = 1
        way.verboseMode = 0
        self.system.SolveDynamic(settings)


def multibody_history(
    bearing: LIRBearing,
    mass: float,
    motion: GroundMotion,
    duration: float,
    options: Options = DEFAULT,
) -> History:
    """Run a mass on one bearing under a motion along x."""
    model = _Model(bearing, mass, motion, options)
    model.run(duration)
    return History(*np.array(model.rows).T)


HALF_PLAN = (6.0, 4.0)  # m: the bearings stand at the corners
CENTRE = 4.0  # m, of the mass above the bearings
CORNERS = tuple(
    (x, y) for x in (-HALF_PLAN[0], HALF_PLAN[0]) for y in (-HALF_PLAN[1], HALF_PLAN[1])
)
STIFF = 1e14  # Pa: the members of a rigid building


def _building_inertia(mass: float) -> tuple[float, float, float]:
    length, width, height = 2.0 * HALF_PLAN[0], 2.0 * HALF_PLAN[1], 2.0 * CENTRE
    pairs = ((width, height), (length, height), (length, width))
    moments = [mass * (a**2 + b**2) / 12.0 for a, b in pairs]
    return moments[0], moments[1], moments[2]


def building_frame(bearing: LIRBearing, mass: float) -> Frame:
    """Return a rigid building on four bearings."""
    section = Section.rectangle(1.0, 1.0, elastic_modulus=STIFF, density=1e-9)
    frame = Frame("rigid building")
    frame.add_node("mass", 0.0, 0.0, bearing.height + CENTRE)
    frame.add_mass("mass", mass, _building_inertia(mass))
    for k, (x, y) in enumerate(CORNERS):
        frame.add_node(f"ground {k}", x, y, 0.0)
        frame.fix(f"ground {k}", "all")
        frame.add_node(f"top {k}", x, y, bearing.height)
        frame.add_member(f"member {k}", "mass", f"top {k}", section)
        frame.add_bearing(f"bearing {k}", f"ground {k}", f"top {k}", bearing)
    return frame


def building_history(
    bearing: LIRBearing,
    mass: float,
    motion: GroundMotion,
    duration: float,
    step: float = 0.005,
    level: Level = "pendulum",
) -> History:
    """Run the same building in Exudyn with the element; return its first bearing's motion.

    The lateral force is the mean of all bearings.
    """
    exudyn, items = (import_module(name) for name in ("exudyn", "exudyn.itemInterface"))
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    down = mass * GRAVITY / len(CORNERS) / bearing.resolved()["axial_stiffness"]
    node = system.AddNode(
        items.NodeRigidBodyRotVecLG(
            referenceCoordinates=[0, 0, bearing.height + CENTRE, 0, 0, 0],
            initialCoordinates=[0, 0, -down, 0, 0, 0],
        )
    )
    inertia = [*_building_inertia(mass), 0.0, 0.0, 0.0]
    body = system.AddObject(items.ObjectRigidBody(mass=mass, inertia=inertia, nodeNumber=node))
    centre = system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[0, 0, 0]))
    pull = np.asarray(motion.x)
    times = motion.dt * np.arange(len(pull))

    def load(_system: Any, t: float, _: Any) -> list[float]:
        return [-mass * float(np.interp(t, times, pull)), 0.0, -mass * GRAVITY]

    weight = items.LoadForceVector(
        markerNumber=centre, loadVector=[0, 0, -mass * GRAVITY], loadVectorUserFunction=load
    )
    system.AddLoad(weight)
    bearings = [
        ExudynBearing(system, bearing, (node, (x, y, -CENTRE)), level=level) for x, y in CORNERS
    ]
    commit, first, rows = after_step(bearings), bearings[0].element, []

    def record(system: Any, time: float) -> bool:
        commit(system, time)
        names = ("displacement", "slip", "axial_force", "rim_force")
        u, slip, axial, rim = (first.response(name) for name in names)
        shear = np.mean([each.element.response("force")[6] for each in bearings])
        rows.append((time, u[6], slip[0], shear, axial, np.max(rim)))
        return True

    system.SetPostStepUserFunction(record)
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.linearSolverType = exudyn.LinearSolverType.EXUdense
    settings.solutionSettings.writeSolutionToFile = False
    way = settings.timeIntegration
    way.endTime, way.numberOfSteps = duration, round(duration / step)
    way.generalizedAlpha.spectralRadius = 0.5
    way.newton.relativeTolerance, way.newton.absoluteTolerance = 1e-6, 0.1
    way.verboseMode = 0
    system.SolveDynamic(settings)
    return History(*np.array(rows).T)
