"""What NCh2745 gives, value by value, and how well each is known."""

from frames.design.codes.code_values import CodeValue
from frames.design.hazard.spectral_shapes import NCH2745_TABLES

VALUES = {
    "spectrum": CodeValue("NCh2745 Of.2003", "elastic spectra by soil and zone", NCH2745_TABLES),
    "damping factor": CodeValue(
        "NCh2745 Of.2003, table of B_D and B_M", "B by the damping", NCH2745_TABLES
    ),
    "displacements": CodeValue("NCh2745 7.3", "D_D and D_M by C_D, C_M and B"),
    "maximum": CodeValue("NCh2745 7.3", "M_M = 1.2", field="maximum"),
    "eccentricity": CodeValue(
        "NCh2745 7.3", "5 % of the longest side", field="accidental_eccentricity"
    ),
    "torsion": CodeValue(
        "NCh2745 7.3", "total at least 1.1 of the centre's", field="least_torsion"
    ),
    "capacity": CodeValue("NCh2745 7.3", "D_TM below the rims"),
    "restoring": CodeValue(
        "NCh2745 10.2", "0.025 W of the second half of D_D, else 3 D_TD", field="restoring"
    ),
    "V_b": CodeValue("NCh2745 7.4", "V_b by the largest stiffness at D_D"),
    "R_1": CodeValue("NCh2745 7.4", "R_1 at most 2", field="largest_reduction"),
    "least V_s": CodeValue("NCh2745 7.4", "wind; 1.5 nominal or the upper activation"),
    "fixed base": CodeValue("NCh433 6.2.3", "V_s at least that of NCh433 at T_D"),
    "activation": CodeValue("NCh2745 7.4", "1.5 times nominal", field="activation"),
    "F_x": CodeValue("NCh2745 7.5", "forces over the height by w h"),
    "drift": CodeValue("NCh2745 7.6", "storey drift at most 0.0025", field="drift"),
    "vertical loads": CodeValue("NCh2745 6.2", "no uplift, pressure of sliders"),
    "overturning": CodeValue("NCh2745 6.2", "of the whole structure, safety 1.0"),
    "orthogonal": CodeValue("NCh2745 6.2", "30 % of the other direction", field="orthogonal"),
    "loads": CodeValue("NCh433 5.5.1 and NCh2745 8.4", "seismic mass and combinations"),
    "number of motions": CodeValue("NCh2745 8.4", "3 motions at least"),
    "mean": CodeValue("NCh2745 8.4", "the mean counts from 7 motions on"),
    "scaling": CodeValue("NCh2745 8.4", "SRSS, 1.17 of the target, 0.5 T_D to 1.25 T_M"),
    "history drift": CodeValue("NCh2745 8.8", "storey drift at most 0.003"),
    "moved masses": CodeValue("NCh2745 8.3", "5 % of the sides in histories"),
    "rims": CodeValue("NCh2745 7.3", "rims are not met below D_TM"),
    "tests": CodeValue("NCh2745 14", "which tests, amplitudes and cycles"),
    "accepted slope": CodeValue("NCh2745 14.4", "the force rises with the displacement"),
    "accepted k_eff": CodeValue(
        "NCh2745 14.4", "effective stiffness of each cycle within 10 % of the test's mean"
    ),
    "specimens": CodeValue(
        "NCh2745 14.4", "mean effective stiffness of two specimens within 10 % of one another"
    ),
    "many cycles, stiffness": CodeValue(
        "NCh2745 14.4", "effective stiffness changes by 20 % at most over the cycles"
    ),
    "many cycles, damping": CodeValue(
        "NCh2745 14.4", "effective damping falls by 20 % at most over the cycles"
    ),
    "stable": CodeValue("NCh2745 14.4", "the bearing stays stable"),
}
"""By name; of what no text was compared it is from memory."""
