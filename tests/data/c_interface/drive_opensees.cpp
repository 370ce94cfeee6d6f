// Calls the element as an analysis does: two trials a step, then force, tangent and commit.
#include <cstdio>

#include "opensees_element.cpp"

static const char *path;
extern "C" const char *OPS_GetString() { return path; }
extern "C" int OPS_GetIntInput(int *count, int *data)
{
    for (int k = 0; k < *count; k++)
        data[k] = k ? k : 10;
    return 0;
}

int main(int, char **words)
{
    Domain domain;
    double motion[25];
    path = words[1];
    Element *element = static_cast<Element *>(OPS_LirBearing());
    element->setDomain(&domain);
    for (;;) {
        for (double &each : motion)
            if (scanf("%lf", &each) != 1)
                return 0;
        domain.time = motion[0];
        for (int trial = 0; trial < 2; trial++) {
            for (int k = 0; k < 12; k++) {
                double off = trial == 0 && k == 6 ? 1e-4 : 0.0;
                domain.nodes[k / 6].displacement(k % 6) = motion[1 + k] + off;
                domain.nodes[k / 6].velocity(k % 6) = motion[13 + k];
            }
            if (element->update() != 0 && trial == 1) // the first one may be refused
                return 1;
        }
        const Vector &force = element->getResistingForce();
        for (int k = 0; k < 12; k++)
            printf("%.17g ", force(k));
        const Matrix &tangent = element->getTangentStiff();
        for (int k = 0; k < 144; k++)
            printf("%.17g%c", tangent(k / 12, k % 12), k < 143 ? ' ' : '\n');
        if (element->commitState() != 0)
            return 1;
    }
}
