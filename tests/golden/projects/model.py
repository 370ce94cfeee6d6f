"""A frame of two storeys on twelve columns, in kN, mm and s, that knows its gravity loads."""

import openseespy.opensees as ops

BAYS, WIDTH, HEIGHT = (3, 2), 6000.0, 3200.0
HELD = globals().get("HELD", 1)  # whether base nodes hold their rotations about x and y
E, G = 200.0, 77.0  # kN/mm2
COLUMN = (20000.0, 6.0e8, 3.0e8, 4.0e8)  # area, J, Iy, Iz
BEAM = (12000.0, 5.0e6, 4.0e7, 4.0e8)
FLOOR = 9.0e-6 * WIDTH**2 * BAYS[0] * BAYS[1]  # kN of each level: 9 kN/m2

ops.wipe()
ops.model("basic", "-ndm", 3, "-ndf", 6)
places = [(i, j) for i in range(BAYS[0] + 1) for j in range(BAYS[1] + 1)]
tag = {(k, place): 1 + n + 12 * k for k in range(3) for n, place in enumerate(places)}
for (k, (i, j)), node in tag.items():
    ops.node(node, WIDTH * i, WIDTH * j, HEIGHT * k)
    if k == 0:
        ops.fix(node, 1, 1, 1, HELD, HELD, 1)
    ops.mass(node, *(3 * [FLOOR / 12 / 9806.65]), 0.0, 0.0, 0.0)
ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
element = 0
for k in range(3):
    for i, j in places:
        ends = [(k + 1, (i, j), 1, COLUMN)] if k < 2 else []
        ends += [(k, (i + 1, j), 2, BEAM)] if i < BAYS[0] else []
        ends += [(k, (i, j + 1), 2, BEAM)] if j < BAYS[1] else []
        for level, place, transform, (area, torsion, iy, iz) in ends:
            element += 1
            two = tag[k, (i, j)], tag[level, place]
            ops.element("elasticBeamColumn", element, *two, area, E, G, torsion, iy, iz, transform)
ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
for node in tag.values():
    ops.load(node, 0.0, 0.0, -FLOOR / 12, 0.0, 0.0, 0.0)
ops.system("BandGeneral")
ops.numberer("RCM")
ops.constraints("Transformation")
ops.integrator("LoadControl", 1.0)
ops.algorithm("Linear")
ops.analysis("Static")
assert ops.analyze(1) == 0
