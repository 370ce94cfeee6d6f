/* The LIR-DCFP bearing as an element, in C: written by `python -m lir_element.library`, @version@.
 *
 * A bearing is an array of doubles of your program: constants, committed state, trial state, scratch.
 * It holds no address: it may be copied, kept and restored. Calls with different bearings may run at
 * the same time. Units: m, N, s, rad. Degrees of freedom: ux, uy, uz, rx, ry, rz of node i (below),
 * then of node j (above); z upwards. Displacements count from the undeformed, unloaded bearing.
 * Matrices go by rows: entry 12 * row + column is the derivative of force `row`. */
#ifndef LIR_ELEMENT_H
#define LIR_ELEMENT_H
#ifdef __cplusplus
extern "C" {
#endif

/* outcomes of a trial and of a commit */
@statuses@
/* outcomes of any call */
#define LIR_NO_FILE (-1)             /* the file cannot be opened: check its path */
#define LIR_NOT_OF_THIS_LIBRARY (-2) /* no bearing, or one of another version: write it anew */
#define LIR_TOO_SMALL (-3)           /* the array is too small: use LIR_SIZE doubles */

/* Read a bearing at its start from a file of `write_bearing`; there is `room` for so many doubles. */
int lir_read(const char *path, double *bearing, int room);

/* Return the doubles that a bearing takes; 0 if the array holds none. */
int lir_size(const double *bearing);

/* Determine the state at displacements, velocities and a time. If the time lies after the committed
 * one, rates are differences over the step. Otherwise the trial is static, and the velocities give
 * the speeds of friction alone. A trial starts from the committed state. If there is no state the
 * trial is forgotten, and the reason returned: shorten the step. */
int lir_trial(double *bearing, const double u[12], const double v[12], double time);

/* Copy the resisting forces of the trial. */
void lir_force(const double *bearing, double force[12]);

/* Copy the consistent, unsymmetric tangent of the trial. */
void lir_tangent(double *bearing, double tangent[144]);

/* Accept the trial; returns the limit that is exceeded, if the bearing has failed. */
int lir_commit(double *bearing);

/* Forget the trial. */
void lir_revert(double *bearing);

#ifdef __cplusplus
}
#endif

/* Sizes, and places in a bearing, from 0; LIR_COMMITTED and LIR_TRIAL are the
 * states, LIR_INITIAL is the stiffness at rest under the design load (144). */
@own@

/* What a state holds: bearing[LIR_TRIAL + LIR_AXIAL_FORCE] is the axial force of the trial. */
@fields@

#endif
