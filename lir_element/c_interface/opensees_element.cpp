// The bearing as an element of OpenSees' interpreters that load packages, over liblir_element.so.
//
//   c++ -shared -fPIC -I<OpenSees sources> opensees_element.cpp -L. -llir_element -o LirBearing.so
//   loadPackage LirBearing; element LirBearing $tag $iNode $jNode bearing.lir
//
// Three-dimensional models with six degrees of freedom a node, z upwards, SI units, an unsymmetric
// solver. If all velocities are zero the trial is static. Otherwise the step runs from the domain's
// time at the last commit: use implicit integrators, which set the time before their trials.
// It was compiled against declarations of our own, and never run inside an interpreter.

#include <Domain.h>
#include <Element.h>
#include <ID.h>
#include <Information.h>
#include <Matrix.h>
#include <Node.h>
#include <OPS_Stream.h>
#include <Vector.h>
#include <elementAPI.h>

#include <algorithm>
#include <vector>

#include "lir_element.h"

class LirBearing : public Element {
  public:
    LirBearing(int tag, int i, int j, const std::vector<double> &read)
        : Element(tag, 0), ends(2), start(read), bearing(read), force(12), matrix(12, 12)
    {
        ends(0) = i;
        ends(1) = j;
    }
    int getNumExternalNodes() const override { return 2; }
    const ID &getExternalNodes() override { return ends; }
    Node **getNodePtrs() override { return nodes; }
    int getNumDOF() override { return 12; }

    void setDomain(Domain *domain) override
    {
        for (int k = 0; k < 2; k++) {
            nodes[k] = domain ? domain->getNode(ends(k)) : nullptr;
            if (domain && (!nodes[k] || nodes[k]->getNumberDOF() != 6)) {
                opserr << "LirBearing: no node with 6 DOFs: " << ends(k) << endln;
                return;
            }
        }
        DomainComponent::setDomain(domain);
        if (domain)
            committed = domain->getCurrentTime();
    }

    int update() override
    {
        double motion[24]; // displacements, velocities
        for (int k = 0; k < 12; k++) {
            motion[k] = nodes[k / 6]->getTrialDisp()(k % 6);
            motion[12 + k] = nodes[k / 6]->getTrialVel()(k % 6);
        }
        bool rests = std::all_of(motion + 12, motion + 24, [](double v) { return v == 0.0; });
        double step = rests ? 0.0 : getDomain()->getCurrentTime() - committed;
        if (tried && step == last && std::equal(motion, motion + 24, lastMotion))
            return 0;
        std::copy(motion, motion + 24, lastMotion);
        last = step;
        double now = bearing[LIR_COMMITTED + LIR_TIME] + step;
        int code = lir_trial(bearing.data(), motion, motion + 12, now);
        tried = code == LIR_OK;
        // a step that begins without a state stands at the committed one, see Newmark's method
        bool stands = std::equal(motion, motion + 12, &bearing[LIR_COMMITTED + LIR_DISPLACEMENT]);
        return tried || stands ? 0 : failed(code);
    }

    int commitState() override
    {
        if (update() != 0) // methods with an alpha try states within the step
            return -1;
        int code = lir_commit(bearing.data());
        committed = getDomain()->getCurrentTime();
        tried = false;
        loaded = loaded || bearing[LIR_COMMITTED + LIR_AXIAL_FORCE] > 0.0;
        return code == LIR_OK ? Element::commitState() : failed(code);
    }

    int revertToLastCommit() override
    {
        lir_revert(bearing.data());
        tried = false;
        return 0;
    }

    int revertToStart() override
    {
        bearing = start;
        committed = 0.0;
        tried = loaded = false;
        return 0;
    }

    const Matrix &getTangentStiff() override
    {
        if (!loaded && bearing[LIR_TRIAL + LIR_AXIAL_FORCE] <= 0.0)
            return getInitialStiff(); // so that an analysis can begin
        lir_tangent(bearing.data(), tangent);
        return filled(tangent);
    }

    const Matrix &getInitialStiff() override { return filled(&bearing[LIR_INITIAL]); }

    const Vector &getResistingForce() override
    {
        for (int k = 0; k < 12; k++)
            force(k) = bearing[LIR_TRIAL + LIR_FORCE + k];
        return force;
    }

    int sendSelf(int, Channel &) override { return -1; } // not for databases and partitions
    int recvSelf(int, Channel &, FEM_ObjectBroker &) override { return -1; }
    void Print(OPS_Stream &s, int) override { s << "LirBearing " << getTag() << endln; }

  private:
    int failed(int code)
    {
        opserr << "LirBearing " << getTag() << ": status " << code << " (lir_element.h)" << endln;
        return -1;
    }

    const Matrix &filled(const double *k)
    {
        for (int at = 0; at < 144; at++)
            matrix(at / 12, at % 12) = k[at];
        return matrix;
    }

    ID ends;
    Node *nodes[2] = {nullptr, nullptr};
    std::vector<double> start, bearing;
    Vector force;
    Matrix matrix;
    double committed = 0.0, last = 0.0, lastMotion[24], tangent[144];
    bool tried = false, loaded = false;
};

extern "C" void localInit() {}

extern "C" void *OPS_LirBearing()
{
    int tags[3], three = 3;
    std::vector<double> bearing(LIR_SIZE);
    if (OPS_GetIntInput(&three, tags) != 0)
        return nullptr;
    const char *path = OPS_GetString();
    int code = lir_read(path, bearing.data(), LIR_SIZE);
    if (code != LIR_OK) {
        opserr << "LirBearing " << tags[0] << ": " << path << ", code " << code << endln;
        return nullptr;
    }
    return new LirBearing(tags[0], tags[1], tags[2], bearing);
}
