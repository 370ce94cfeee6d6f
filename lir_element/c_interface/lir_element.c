/* The few calls of lir_element.h around the compiled kernels, which have the level in their names. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "lir_element.h"

extern int64_t lir_trial_pendulum(double *, const double *, const double *, double);
extern int64_t lir_trial_contact(double *, const double *, const double *, double);
extern int64_t lir_tangent_pendulum(double *), lir_tangent_contact(double *);
extern int64_t lir_commit_pendulum(double *), lir_commit_contact(double *);
extern int64_t lir_look_contact(double *);

enum { LAYOUT, SIZE, LEVEL, HAS_TANGENT, PENDING };
#define AT_LEVEL(bearing, name) (bearing[LEVEL] == 1.0 ? lir_##name##_contact : lir_##name##_pendulum)

int lir_read(const char *path, double *bearing, int room)
{
    double head[LEVEL];
    int code = LIR_NOT_OF_THIS_LIBRARY;
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return LIR_NO_FILE;
    if (fread(head, sizeof head, 1, file) == 1 && head[LAYOUT] == LIR_LAYOUT) {
        size_t count = (size_t)head[SIZE];
        rewind(file);
        if (room < (int)count)
            code = LIR_TOO_SMALL;
        else if (fread(bearing, sizeof *bearing, count, file) == count)
            code = LIR_OK;
        else
            bearing[LAYOUT] = 0.0;
    }
    fclose(file);
    return code;
}

int lir_size(const double *bearing) { return bearing[LAYOUT] == LIR_LAYOUT ? (int)bearing[SIZE] : 0; }

int lir_trial(double *bearing, const double u[12], const double v[12], double time)
{
    if (!lir_size(bearing))
        return LIR_NOT_OF_THIS_LIBRARY;
    int code = (int)AT_LEVEL(bearing, trial)(bearing, u, v, time);
    bearing[HAS_TANGENT] = 0.0;
    bearing[PENDING] = 1.0;
    if (!(LIR_HAS_NO_STATE >> code & 1))
        return LIR_OK;
    lir_revert(bearing);
    return code;
}

void lir_force(const double *bearing, double force[12])
{
    memcpy(force, bearing + LIR_TRIAL + LIR_FORCE, 12 * sizeof *force);
}

void lir_tangent(double *bearing, double tangent[144])
{
    if (bearing[HAS_TANGENT] == 0.0)
        AT_LEVEL(bearing, tangent)(bearing);
    bearing[HAS_TANGENT] = 1.0;
    memcpy(tangent, bearing + LIR_TANGENT, 144 * sizeof *tangent);
}

int lir_commit(double *bearing)
{
    int64_t status;
    double tangent[144];
    if (!lir_size(bearing))
        return LIR_NOT_OF_THIS_LIBRARY;
    if (bearing[PENDING] == 0.0)
        return LIR_OK;
    bearing[PENDING] = 0.0;
    if (bearing[LEVEL] == 1.0)
        lir_tangent(bearing, tangent); /* which may be asked for after the commit */
    AT_LEVEL(bearing, commit)(bearing);
    memcpy(&status, bearing + LIR_COMMITTED + LIR_STATUS, sizeof status);
    return (int)status;
}

void lir_revert(double *bearing)
{
    const double rest[12] = {0.0}, *committed = bearing + LIR_COMMITTED;
    if (bearing[LEVEL] == 1.0)
        lir_look_contact(bearing);
    else
        lir_trial_pendulum(bearing, committed + LIR_DISPLACEMENT, rest, committed[LIR_TIME]);
    memcpy(bearing + LIR_TRIAL, committed, LIR_STATE_SIZE * sizeof *bearing);
    bearing[HAS_TANGENT] = bearing[PENDING] = 0.0;
}
