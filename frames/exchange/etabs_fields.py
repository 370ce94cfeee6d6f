"""Text of ETABS: fields by kind, fields without effect, refused lines."""

import math

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
    lacks,
)

DOFS = ("UX", "UY", "UZ", "RX", "RY", "RZ")
"""Displacements of a point."""

POINT = fields("x=X y=Y", "length", None) + fields("below=Below", "length")
MATERIAL = (
    Field("weight", "WEIGHTPERVOLUME", "weight"),
    Field("density", "MASSPERVOLUME", "density"),
    Field("elastic_modulus", "E|E1", "stress", bound=POSITIVE),
    Field("poisson_ratio", "U|U1", bound=POISSON),
)
PATTERN = (*fields("kind=TYPE", "text", "Other"), *fields("self_weight=SELFWEIGHT"))
MASS_SOURCE = fields(
    "elements=INCLUDEELEMENTS added=INCLUDEADDEDMASS loads=INCLUDELOADS lumped=LUMPATSTORIES "
    "default=ISDEFAULT",
    "yes",
    default=False,
)
MASS_OPTIONS = fields("lumped=STORYLEVELONLY", "yes", default=False)
_OUTER = fields("depth=D width=B", "length")
SIZES = _OUTER + fields("flange=TF web=TW|T|TF", "length")
SECTION = (
    *fields("material=MATERIAL", "text", ""),
    *fields("shape=SHAPE", "text", "General"),
    *_OUTER,
    *fields("area=AREA", "area", None),
    *fields("shear_2=AS2 shear_3=AS3", "area", zero=math.inf),
    *fields("inertia_33=I33 inertia_22=I22", "inertia", None),
    *fields("torsion=TORSION", "inertia"),
)
MODIFIERS = factors(OF_FRAMES, "AMOD A2MOD A3MOD JMOD I2MOD I3MOD MMOD WMOD")
FRAME_MODIFIERS = factors(
    OF_FRAMES, "PROPMODA PROPMODA2 PROPMODA3 PROPMODT PROPMODI22 PROPMODI33 PROPMODM PROPMODW"
)
THICKNESS = fields("thickness=SLABTHICKNESS|WALLTHICKNESS|OVERALLDEPTH|TM", "length")
DECK = (
    *fields("slab=DECKSLABDEPTH", "length", None),
    *fields("depth=DECKRIBDEPTH top=DECKRIBWIDTHTOP spacing=DECKRIBSPACING", "length"),
    *fields("bottom=DECKRIBWIDTHBOTTOM|DECKRIBWIDTHTOP", "length"),
    *fields("extra_weight=DECKUNITWEIGHT", "stress"),
)
SHELL = factors(OF_SHELLS, "F11MOD F22MOD F12MOD M11MOD M22MOD M12MOD MMOD WMOD")
AREA_MODIFIERS = factors(
    OF_SHELLS, "PROPMODF11 PROPMODF22 PROPMODF12 PROPMODM11 PROPMODM22 PROPMODM12 PROPMODM PROPMODW"
)
END_ZONES = (
    *fields("end_i=LENGTHOFFI end_j=LENGTHOFFJ", "length", bound=NOT_NEGATIVE),
    Field("rigid", "RIGIDZONE", bound=SHARE),
)
OFFSETS = fields(" ".join(f"{a}{e}=OFFSET{a}{e}" for e in "IJ" for a in "XYZ"), "length")
SUPPORT = fields("ux=UX uy=UY uz=UZ", "line") + fields("rx=RX ry=RY rz=RZ", "moment")
"""Springs of a point."""

MASS = (
    *fields("plan=MASSUXUY uz=MASSUZ", "mass"),
    *fields("rx=MASSRX ry=MASSRY rz=MASSRZ", "rotary"),
)
LINK = (
    *fields("kind=TYPE", "text", ""),
    *fields("mass=MASS", "mass"),
    *fields("weight=WEIGHT", "force"),
)
_ANY_TURN = (
    *fields("ratio=KRATIO slow=CSLOW fast=CFAST"),
    *fields("rate=RATE", "per_length"),
    *fields("radius=RADIUS place=DJ", "length"),
)
LINEAR = {
    False: fields("own=STIFF stiffness=KE damping=CE", "line"),
    True: fields("own=STIFF stiffness=KE damping=CE", "moment"),
}
"""Stiffness and damping of a link's deformation by whether it is a rotation: words after U2."""

NONLINEAR = {
    False: (
        *fields("stiffness=K", "line"),
        *fields("yield=YIELD", "force"),
        *fields("open=OPEN", "length"),
        *_ANY_TURN,
    ),
    True: (*fields("stiffness=K yield=YIELD", "moment"), *fields("open=OPEN"), *_ANY_TURN),
}
"""Nonlinear numbers of a link's deformation by whether it is a rotation: words after U2."""

FORCES = fields("fx=FX fy=FY fz=FZ", "force") + fields("mx=MX my=MY mz=MZ", "moment")
_LC = fields("pattern=LC", "patterns", None, said="load pattern")
POINT_LOAD = FORCES + _LC
_WAY = (*_LC, *fields("way=DIR", "text", "GRAV"))
_UNIFORM = "start=FVAL end=FVAL"
LINE_LOAD = {
    "UNIFF": fields(_UNIFORM, "line", None) + _WAY,
    "POINTF": fields(_UNIFORM, "force", None) + fields("a=RDIST b=RDIST", default=None) + _WAY,
    "TRAPF": (
        *fields("start=FSTART end=FEND", "line", None),
        *fields("a=RDSTART"),
        *fields("b=RDEND", default=1.0),
        *_WAY,
    ),
}
"""Loads along lines by their kind."""

AREA_LOAD = _WAY + fields("size=FVAL", "stress", None)
LOAD_SET = (
    *fields("pattern=LOADPAT", "patterns", None, said="load pattern"),
    *fields("size=VALUE", "stress", None),
)
MASS_SHARE = (
    *fields("pattern=Pattern|LOAD", "patterns", None, said="load pattern"),
    *fields("share=Factor|FACTOR", default=None),
)
CASE = fields("case=Case pattern=LOADPAT", "text", None) + fields("factor=SF", default=1.0)
COMBINATION = fields("name=Combo case=LOADCASE", "text", None) + fields("factor=SF", default=1.0)

_LIMITS = "limits of axial force, without"
FRAME_WORDS = (
    Refusal("LIMITTENSION|LIMITCOMPRESSION", "tension limits", _LIMITS, is_none_of("none")),
    Refusal("HINGE", "hinges", "plastic hinges of frames, which stay elastic", is_none_of("none")),
    Refusal("Text", "line and area springs", "springs along lines", has("spring")),
    Refusal("SPRINGPROP", "line and area springs", "springs along lines", is_none_of("none")),
)
_RIBBED = "a ribbed or waffle slab, taken as a flat one of its slab's thickness"
_LAYERED = "a layered shell, taken as a linear one of its thickness"
SHELL_WORDS = (
    Refusal("MODELINGTYPE|TYPE", "layered shells", _LAYERED, has("layered")),
    Refusal("SLABTYPE", "ribbed slabs", _RIBBED, has("ribbed", "waffle")),
)
_OPENING = "openings in slabs, whose loads are not taken away"
_SPRINGS = "line and area springs"
_ON_SOIL = "springs under areas; if they hold the building, supports under columns take their place"
AREA_SPRINGS = (
    Refusal("Text", _SPRINGS, _ON_SOIL, has("spring")),  # of ETABS 8 and 9
    Refusal("SPRINGPROP", _SPRINGS, _ON_SOIL, is_none_of("none")),
)
AREA_WORDS = (Refusal("OPENING", "openings", _OPENING, is_none_of("no", "none")),)
POINT_LOAD_WORDS = (
    Refusal("TYPE", "imposed strains", 'loads of type "{}" on points', is_none_of("force")),
)
_KINDS = is_none_of("uniff", "trapf", "pointf")
LINE_LOAD_WORDS = (Refusal("TYPE", "imposed strains", 'loads of type "{}" on lines', _KINDS),)
SPRING_WORDS = (Refusal("AXIALDIR", "links", "springs of points by links along {}", lacks("z")),)

NAMES = {
    "STORY": ("Story",),
    "MATERIAL": ("Material",),
    "FRAMESECTION": ("Section",),
    "CONCRETESECTION": ("Section",),
    "SHELLPROP": ("Section",),
    "LINKPROP": ("Link",),
    "DIAPHRAGM": ("Diaphragm",),
    "POINTSPRING": ("Spring",),
    "POINTASSIGN": ("Point", "Story"),
    "LINEASSIGN": ("Line", "Story"),
    "AREAASSIGN": ("Area", "Story"),
    "LINKASSIGN": ("Link",),
    "POINTLOAD": ("Point", "Story"),
    "LINELOAD": ("Line", "Story"),
    "AREALOAD": ("Area", "Story"),
    "LOADPATTERN": ("Pattern",),
    "LOADCASE": ("Case",),
    "COMBO": ("Combo",),
    "MASSSOURCE": ("Source",),
    "MASSSOURCELOAD": ("Source", "Pattern", "Factor"),
    "GROUP": ("Group",),
    "UNITS": ("Force", "Length", "Temperature"),
    "POINT": ("Point", "X", "Y", "Below"),
    "LINE": ("Line", "Kind", "I", "J", "Stories"),
    "SHELLUNIFORMLOADSET": ("Set",),
    "NAMEDFMODIFIER": ("Modifier",),
    "NAMEDSHMODIFIER": ("Modifier",),
}
"""Positional values of a line by its first word; words with values follow."""

ALIASES = {
    "MATERIAL": {"M": "MASSPERVOLUME", "W": "WEIGHTPERVOLUME"},
    "SHELLPROP": {
        "ONEWAY": "ONEWAYLOADDIST",
        "SLABDEPTH": "DECKSLABDEPTH",
        "RIBDEPTH": "DECKRIBDEPTH",
        "RIBWIDTH": "DECKRIBWIDTHTOP",
        "RIBSPACING": "DECKRIBSPACING",
        "WEIGHT": "DECKUNITWEIGHT",
    },
    "COMBO": {"LOAD": "LOADCASE"},
}
"""Words of ETABS 8 and 9 by first word, and those of later versions that mean the same."""

REFUSED = (
    ("HINGEASSIGN", "hinges", "plastic hinges of frames, which stay elastic"),
    ("AREAHINGEASSIGN", "hinges", "plastic hinges of walls, which stay elastic"),
    ("TENDONASSIGN", "tendons", "tendons"),
    ("LINESPRING", "line and area springs", "springs along lines"),
    ("AREASPRING", "line and area springs", "springs under areas"),
    ("AREAJOINTOFFSETDATA", "area overwrites", "offsets of corners of areas"),
    ("AREATHICKNESSOVERWRITE", "area overwrites", "thickness of single areas"),
    ("AREAEDGERELEASE", "edge releases", "releases along edges of areas"),
    ("LINECURVEDATA", "curved frames", "curved lines, taken as straight ones"),
    ("AREACURVEDATA", "curved areas", "curved edges of areas, taken as straight ones"),
    ("STAGE", "staged construction", "stages of construction, taken as built at once"),
    ("SEQUENTIAL", "staged construction", "stages of construction, taken as built at once"),
)
"""Lines whose loss would change the answer: beginning of the first word, key of `allow`, name."""

KNOWN = {
    "": " ".join(
        ["GUID NOTES COLOR Name Area Kind Ends", *(n for ns in NAMES.values() for n in ns)]
    ),
    "AREAASSIGN": "ADDRESTRAINT CARDINALPOINT DIAPHRAGMTOFLOOR LINECONSTRAINT MAXMESHSIZE MESHAT "
    "MESHFLOORN1 MESHFLOORN2 "
    "OBJMESHTYPE PIER SPANDREL TRANSFORMSTIFFNESSFOROFFSETS=NO",
    "COMBO": "*",
    "CONCRETESECTION": "*",
    "FRAMESECTION": "FILE INCLUDEAUTORIGIDZONEAREA NOTIONALUSERVALUE NOTIONALSIZE R22 R33 S22NEG "
    "S22POS S33NEG S33POS Z22 Z33",
    "LINEASSIGN": "AUTOMESH FLOORMESH MAXSTASPC MESH MESHATINTERSECTIONS MINNUMSTA PIER "
    "SELFWEIGHTOPTION SPANDREL",
    "LINKPROP": "*",
    "LOADCASE": "*",
    "MASSOPTIONS": "GRAVITY LATERALONLY",
    "MASSSOURCE": "INCLUDELATERALMASS=YES INCLUDEMOVE=NO INCLUDEVERTICALMASS",
    "MATERIAL": "A CPCOMPRESSION CPTENSION DESIGNTYPE EFFFU EFFFY ENERGYDEGFACT FC FINALSLOPE FU "
    "FUE FY FYE FYS GRADE HYSTYPE IGNORETENSIONACCEPTANCE IOCOMPRESSION IOTENSION LSCOMPRESSION "
    "LSTENSION POINTID PRICE SSTYPE STRAIN STRAINATFC STRAINATHARDENING STRAINATMAXSTRESS "
    "STRAINATRUPTURE STRAINATULTIMATE STRESS SYMTYPE=ISOTROPIC SYMTYPE=UNIAXIAL TIMEDEPCONCCODE "
    "TYPE",
    "POINTASSIGN": "USERJOINT",
    "POINTSPRING": "STIFFNESSOPTION",
    "PROGRAM": "*",
    "SHELLPROP": "DECKMATERIAL DECKSHEARTHICKNESS DECKTYPE PLATETYPE SHEARSTUDDIAM SHEARSTUDFU "
    "SHEARSTUDHEIGHT",
    "STORY": "MASTERSTORY SIMILARTO SPLICEABOVE SPLICEHEIGHT",
}
"""Words without effect on the frame, for `Tables.unknown`."""
