/* The forces and tangents of a bearing along a motion.
 *
 *   cc example.c -L. -llir_element -Wl,-rpath,'$ORIGIN' -o example
 *   ./example bearing.lir < motion.txt > forces.txt
 *
 * A line of motion.txt is a time, 12 displacements and 12 velocities; one of forces.txt holds the 12
 * forces, then the tangent by rows. A step without a state, or beyond a limit, ends the program. */

#include <stdio.h>
#include <stdlib.h>

#include "lir_element.h"

static int read_step(double *time, double u[12], double v[12])
{
    if (scanf("%lf", time) != 1)
        return 0;
    for (int k = 0; k < 24; k++)
        if (scanf("%lf", k < 12 ? &u[k] : &v[k - 12]) != 1)
            return 0;
    return 1;
}

int main(int count, char **words)
{
    static double bearing[LIR_SIZE];
    double time, u[12], v[12], force[12], tangent[144];
    int code = count == 2 ? lir_read(words[1], bearing, LIR_SIZE) : LIR_NO_FILE;
    if (code != LIR_OK) {
        fprintf(stderr, "%s: code %d of lir_read (lir_element.h); use ./example BEARING.lir\n",
                count == 2 ? words[1] : "no file", code);
        return EXIT_FAILURE;
    }
    while (read_step(&time, u, v)) {
        code = lir_trial(bearing, u, v, time);
        if (code == LIR_OK) {
            lir_force(bearing, force);
            lir_tangent(bearing, tangent);
            for (int k = 0; k < 156; k++)
                printf("%.17g%c", k < 12 ? force[k] : tangent[k - 12], k < 155 ? ' ' : '\n');
            code = lir_commit(bearing);
        }
        if (code != LIR_OK) {
            fprintf(stderr, "time %g s: status %d (lir_element.h)\n", time, code);
            return EXIT_FAILURE;
        }
    }
    return EXIT_SUCCESS;
}
