"""Tables of SAP2000: fields by kind, fields without effect, refused tables."""

import math

from frames.exchange.building import RELEASES as RELEASED
from frames.exchange.fields import (
    NOT_NEGATIVE,
    OF_FRAMES,
    OF_SHELLS,
    POISSON,
    POSITIVE,
    SHARE,
    Field,
    Refusal,
    factors,
    fields,
    has,
    is_none_of,
)

MATERIALS = "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"
SECTIONS = "FRAME SECTION PROPERTIES 01 - GENERAL"
AREA_SECTIONS = "AREA SECTION PROPERTIES"
LINKS = "LINK PROPERTY DEFINITIONS"
PATTERNS = "LOAD PATTERN DEFINITIONS"
JOINTS, FRAMES, AREAS = "JOINT COORDINATES", "CONNECTIVITY - FRAME", "CONNECTIVITY - AREA"
LINK_PLACES = "CONNECTIVITY - LINK"

RESTRAINT = fields("ux=U1 uy=U2 uz=U3 rx=R1 ry=R2 rz=R3", "yes", default=False)
"""Displacements of a joint that are held."""

TIED = fields("ux=UX uy=UY uz=UZ rx=RX ry=RY rz=RZ", "yes", default=True)
"""Displacements that a constraint ties."""

GLOBAL = fields("x=GlobalX y=GlobalY z=GlobalZ", "length", None)
OWN = fields("x=XorR y=Y z=Z", "length", None)

MATERIAL = (
    Field("elastic_modulus", "E1", "stress", None, POSITIVE),
    Field("poisson_ratio", "U12", bound=POISSON),
    Field("shear_modulus", "G12", "stress"),
    Field("density", "UnitMass", "density"),
    Field("weight", "UnitWeight", "weight"),
)
PATTERN = (*fields("kind=DesignType", "text", "Other"), *fields("self_weight=SelfWtMult"))
_OUTER = fields("depth=t3 width=t2", "length")
SIZES = _OUTER + fields("flange=tf web=tw", "length")
OUTLINE = ("tf", "tw", "t2b", "tfb")
"""Sizes that a section with constants of its own does not need."""

SECTION = (
    *fields("material=Material", "text", ""),
    *fields("shape=Shape", "text", "General"),
    *_OUTER,
    *fields("area=Area", "area", None),
    *fields("torsion=TorsConst", "inertia"),
    *fields("inertia_33=I33 inertia_22=I22", "inertia", None),
    *fields("shear_2=AS2 shear_3=AS3", "area", zero=math.inf),
)
MODIFIERS = factors(
    OF_FRAMES,
    "AMod A2Mod|AS2Mod A3Mod|AS3Mod JMod I2Mod|I22Mod I3Mod|I33Mod MassMod|MMod WeightMod|WMod",
)
THICKNESS = (
    Field("thickness", "Thickness", "length", bound=POSITIVE),
    Field("bending_thickness", "BendThick", "length"),
)
SHELL = factors(
    OF_SHELLS,
    "F11Mod|f11 F22Mod|f22 F12Mod|f12 M11Mod|m11 M22Mod|m22 M12Mod|m12 MMod|MassMod WMod|WeightMod",
)
END_ZONES = (
    *fields(
        "end_i=LengthI|LengthOffI|EndI|OffsetI end_j=LengthJ|LengthOffJ|EndJ|OffsetJ",
        "length",
        bound=NOT_NEGATIVE,
    ),
    Field("rigid", "RigidFactor|RigidFact", bound=SHARE),
)
ENDS = fields("i=JointI j=JointJ", "joints", None)
ANGLE = fields("angle=Angle")
RELEASES = fields(" ".join(f"{w}{e}={w}{e}" for e in "IJ" for w in RELEASED), "yes", default=False)
TRANSFORMS = fields("a=StiffTransform b=StiffTrans c=Transform", "yes", default=True)
MESHED = fields("auto=AutoMesh at_joints=AtJoints", "yes", default=True)
OFFSETS = fields(" ".join(f"{a}{e}=JtOffset{a}{e}" for e in "IJ" for a in "XYZ"), "length")
SUPPORT = (
    *fields("ux=U1 uy=U2 uz=U3", "line", bound=NOT_NEGATIVE),
    *fields("rx=R1 ry=R2 rz=R3", "moment", bound=NOT_NEGATIVE),
)
"""Springs of a joint."""

MASS = (
    *fields("ux=Mass1 uy=Mass2 uz=Mass3", "mass", bound=NOT_NEGATIVE),
    *fields("rx=MMI1 ry=MMI2 rz=MMI3", "rotary", bound=NOT_NEGATIVE),
)
LINK = (
    *fields("kind=LinkType", "text", ""),
    *fields("mass=Mass", "mass"),
    *fields("weight=Weight", "force"),
)
_FIXED = fields("fixed=Fixed", "yes", default=False)
LINEAR = {
    False: _FIXED + fields("stiffness=TransKE damping=TransCE", "line"),
    True: _FIXED + fields("stiffness=RotKE damping=RotCE", "moment"),
}
"""Fixity of a link's deformation, its stiffness and damping; by translation or rotation."""

_ANY_TURN = (
    *fields("ratio=Ratio exponent=YieldExp slow=Slow fast=Fast damping_exponent=CExp"),
    *fields("rate=Rate", "per_length"),
    *fields("radius=Radius place=DJ", "length"),
)
NONLINEAR = {
    False: (
        *fields("stiffness=TransK damping=TransC", "line"),
        *fields("yield=TransYield", "force"),
        *fields("open=TransOpen", "length"),
        *_ANY_TURN,
    ),
    True: (
        *fields("stiffness=RotK damping=RotC yield=RotYield", "moment"),
        *fields("open=RotOpen"),
        *_ANY_TURN,
    ),
}
"""Nonlinear numbers of a link's deformation, by whether it is a rotation."""

_FRAME, _AREA = fields("frame=Frame", "frames", None), fields("area=Area", "areas", None)
_PATTERN = fields("pattern=LoadPat|LoadCase", "patterns", None)
FORCES = fields("fx=F1 fy=F2 fz=F3", "force") + fields("mx=M1 my=M2 mz=M3", "moment")
_JOINT = fields("joint=Joint", "joints", None)
LOADED, JOINT_LOAD = _JOINT + _PATTERN, _JOINT + FORCES + _PATTERN
LINE_LOAD = (*_FRAME, *_PATTERN, *fields("way=Dir", "text", None))
SPREAD = fields("start=FOverLA end=FOverLB", "line", None)
POINT = fields("start=Force end=Force", "force", None)
RELATIVE = {
    False: fields("a=RelDistA b=RelDistB", default=None),
    True: fields("a=RelDist b=RelDist", default=None),
}
ABSOLUTE = {
    False: fields("a=AbsDistA b=AbsDistB", "length", None),
    True: fields("a=AbsDist b=AbsDist", "length", None),
}
"""Begin and end of a load along a frame object, for a distributed load or a force at a point."""

_MULTIPLE = (*_PATTERN, *fields("x=MultiplierX y=MultiplierY z=MultiplierZ"))
FRAME_GRAVITY, AREA_GRAVITY = _FRAME + _MULTIPLE, _AREA + _MULTIPLE
AREA_LOAD = (
    *_AREA,
    *fields("size=UnifLoad", "stress", None),
    *_PATTERN,
    *fields("way=Dir", "text", None),
)
MASS_SOURCE = (
    *fields("name=MassSource", "text", ""),
    *fields("elements=Elements added=Masses default=IsDefault", "yes", default=False),
    *fields("loads=Loads", "yes", default=True),
)
MASS_SHARE = (*_PATTERN, *fields("share=Multiplier", default=None))
CASE = (
    *fields("case=Case", "text", None),
    *fields("pattern=LoadName", "text", ""),
    *fields("factor=LoadSF", default=1.0),
)
COMBINATION = (
    *fields("name=ComboName", "text", None),
    *fields("case=CaseName", "text", ""),
    *fields("factor=ScaleFactor", default=1.0),
)

SECTION_WORDS = (
    Refusal("Shape", "nonprismatic sections", "a nonprismatic section", has("nonprismatic")),
)
_LAYERED = "a layered shell, taken as a linear one of its thickness"
LAYERED = (Refusal("AreaType|Type", "layered shells", _LAYERED, has("layered", "nonlinear")),)
_NO_SHELL = 'an area of type "{}", of which loads alone are read'
NO_SHELL = (Refusal("AreaType", "plane and solid areas", _NO_SHELL, is_none_of("shell")),)
_TURNED = "advanced or mirrored local axes of frames, taken by their angle alone"
_PARTLY = "partial fixity of end releases, taken as full releases"
FRAME_WORDS = (
    Refusal("IsCurved", "curved frames", "curved frames, taken as straight ones"),
    Refusal("AdvanceAxes|MirrorAbt2|MirrorAbt3", "advanced axes", _TURNED),
    Refusal("PartialFix", "partial fixity", _PARTLY),
)
LOAD_WORDS = (Refusal("Type", "moments along frames", "moments along frames", has("moment")),)
_INCLINED = "diaphragms that are not horizontal"
CONSTRAINT_WORDS = (Refusal("Axis", "other constraints", _INCLINED, is_none_of("z", "auto")),)

REFUSED = (
    ("FRAME HINGE ASSIGN", "hinges", "plastic hinges of frames, which stay elastic"),
    ("CONNECTIVITY - CABLE", "cables", "cables"),
    ("CONNECTIVITY - TENDON", "tendons", "tendons"),
    ("CONNECTIVITY - SOLID", "solids", "solids"),
    ("FRAME TENSION AND COMPRESSION LIMITS", "tension limits", "limits of axial force, without"),
    ("CASE - STATIC 5", "staged construction", "stages of construction, taken as built at once"),
    ("CASE - STATIC 6", "staged construction", "stages of construction, taken as built at once"),
    ("JOINT SPRING ASSIGNMENTS 2", "coupled springs", "coupled springs of joints"),
    ("FRAME SPRING ASSIGNMENTS", "line and area springs", "springs along frames"),
    ("AREA SPRING ASSIGNMENTS", "line and area springs", "springs under areas"),
    ("FRAME RELEASE ASSIGNMENTS 2", "partial fixity", "partial fixity, taken as full releases"),
    ("FRAME LOCAL AXES ASSIGNMENTS 2", "advanced axes", "advanced axes of frames"),
    ("AREA OVERWRITES", "area overwrites", "thickness and joint offsets of single areas"),
    ("AREA EDGE CONSTRAINT", "edge constraints", "constraints along edges of areas"),
    ("FRAME LOADS - TEMPERATURE", "imposed strains", "temperatures of frames"),
    ("FRAME LOADS - STRAIN", "imposed strains", "strains of frames"),
    ("FRAME LOADS - DEFORMATION", "imposed strains", "deformations of frames"),
    ("FRAME LOADS - TARGET", "imposed strains", "target forces of frames"),
    ("JOINT LOADS - GROUND DISPLACEMENT", "imposed strains", "displacements of supports"),
    ("AREA LOADS - TEMPERATURE", "imposed strains", "temperatures of areas"),
    ("AREA LOADS - STRAIN", "imposed strains", "strains of areas"),
    ("AREA LOADS - SURFACE PRESSURE", "surface pressures", "pressures on faces of areas"),
    ("AREA ADDED MASS", "added masses", "masses added to areas"),
    ("FRAME ADDED MASS", "added masses", "masses added to frames"),
    ("JOINT ADDED MASS BY", "added masses", "masses added to joints by weight or volume"),
)
"""Tables whose loss would change the answer: beginning of the name, key of `allow`, name."""

HARMLESS = (
    "AREA AUTO MESH",
    "AREA BRIDGE",
    "AREA LOCAL AXES",
    "AREA SECTION PROPERTY",
    "AREA VEHICLE",
    "FRAME BRIDGE",
    "FRAME DESIGN",
    "FRAME JOINT OFFSETS - BRIDGE",
    "FRAME LOAD TRANSFER",
    "FRAME LOADS - OPEN STRUCTURE",
    "FRAME OUTPUT STATION",
    "FRAME P-DELTA",
    "FRAME PROGRAM DETERMINED",
    "FRAME SECTION PROPERTIES",
    "FRAME VEHICLE",
    "JOINT BRIDGE",
    "JOINT MERGE",
    "JOINT PANEL ZONE",
    "JOINT PATTERN",
    "JOINT VEHICLE",
    "LINK BRIDGE",
    "LINK FREQUENCY",
    "LINK VEHICLE",
)
"""Tables of objects that the linear model does not need, by the beginning of the name."""

KNOWN = {
    "": "GUID Notes Color Joint Frame Area Link Name Material Section SectionName LoadPat "
    "Length CentroidX CentroidY CentroidZ",
    "AREA LOADS": "CoordSys=GLOBAL CoordSys=Local DistType=Twoway",
    "AREA SECTION PROPERTIES": "Arc CoordSys DrillDOF InComp MatAngle TotalMass TotalWt "
    "V13Mod=1 V23Mod=1",
    "AREA SECTION ASSIGNMENTS": "MatProp=Default",
    "CASE - STATIC 1": "*",
    "COMBINATION DEFINITIONS": "*",
    "CONNECTIVITY - AREA": "AreaArea NumJoints Perimeter",
    "CONSTRAINT DEFINITIONS": "CoordSys=GLOBAL MultiLevel",
    "FRAME AUTO MESH": "AtFrames=No MaxDegrees MaxLength NumSegments",
    "FRAME INSERTION POINT": "CoordSys=GLOBAL Mirror2=No Mirror3=No",
    "FRAME LOADS": "AbsDist AbsDistA AbsDistB CoordSys=GLOBAL CoordSys=Local RelDist RelDistA "
    "RelDistB",
    "FRAME LOCAL AXES": "Angle",
    "FRAME OFFSET": "OffsetType Type",
    "FRAME SECTION ASSIGNMENTS": "AutoSelect DesignSect SectionType",
    "FRAME SECTION PROPERTIES": "ConcBeam ConcCol CGOffset2 CGOffset3 EccV2 EccV3 FileName "
    "FilletRadius FromFile I23 PNAOffset2 PNAOffset3 R22 R33 S22 S22Left S22Neg S22Pos S22Right "
    "S33 S33Bot S33Neg S33Pos S33Top SectInFile TotalMass TotalWt Z22 Z33",
    "GROUPS": "*",
    "JOINT ADDED MASS": "CoordSys=GLOBAL CoordSys=Local",
    "JOINT COORDINATES": "CoordSys CoordType SpecialJt T XorR Y Z",
    "JOINT CONSTRAINT": "Type",
    "JOINT LOCAL AXES": "AdvanceAxes=No AdvancedAxes=No",
    "LINK LOCAL AXES": "AdvanceAxes=No AdvancedAxes=No",
    "LINK PROPERTY ASSIGNMENTS": "LinkFDProp=None LinkType",
    "LINK PROPERTY DEFINITIONS 01": "DefArea DefLength PDM2I PDM2J PDM3I PDM3J RotInert1=0 "
    "RotInert2=0 RotInert3=0",
    "LOAD PATTERN": "AutoLoad",
    "MASS SOURCE": "Elements IsDefault LoadPat Loads MassSource Masses Multiplier",
    "MATERIAL PROPERTIES 01": "Grade SymType=Isotropic SymType=Uniaxial TempDepend=No Type",
    "MATERIAL PROPERTIES 02": "A1",
    "PROGRAM CONTROL": "*",
}
"""Fields without effect on the frame, for `Tables.unknown`."""

OBJECTS = ("CONNECTIVITY", "CONSTRAINT DEFINITIONS", "JOINT ", "FRAME ", "AREA ", "LINK ")

"""Beginnings of tables of objects: one that is not known may change the answer."""
