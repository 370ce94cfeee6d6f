/* Declarations that an element of OpenSees needs, written anew: as much as the test calls. */
#pragma once
#include <iostream>
#include <vector>

using OPS_Stream = std::ostream;
#define opserr std::cerr
#define endln '\n'

class Vector {
  public:
    explicit Vector(int n) : data(n) {}
    double &operator()(int k) { return data[k]; }
    double operator()(int k) const { return data[k]; }

  private:
    std::vector<double> data;
};

class Matrix {
  public:
    Matrix(int n, int m) : columns(m), data(n * m) {}
    double &operator()(int i, int j) { return data[columns * i + j]; }
    double operator()(int i, int j) const { return data[columns * i + j]; }

  private:
    int columns;
    std::vector<double> data;
};

class ID {
  public:
    explicit ID(int n) : data(n) {}
    int &operator()(int k) { return data[k]; }

  private:
    std::vector<int> data;
};

class Node {
  public:
    const Vector &getTrialDisp() { return displacement; }
    const Vector &getTrialVel() { return velocity; }
    int getNumberDOF() const { return 6; }
    Vector displacement = Vector(6), velocity = Vector(6);
};

class Domain {
  public:
    Node *getNode(int tag) { return &nodes[tag - 1]; }
    double getCurrentTime() { return time; }
    Node nodes[2];
    double time = 0.0;
};

class Channel;
class FEM_ObjectBroker;

class DomainComponent {
  public:
    explicit DomainComponent(int tag) : tag(tag) {}
    virtual ~DomainComponent() = default;
    virtual void setDomain(Domain *given) { domain = given; }
    virtual Domain *getDomain() const { return domain; }
    int getTag() const { return tag; }
    virtual int sendSelf(int, Channel &) = 0;
    virtual int recvSelf(int, Channel &, FEM_ObjectBroker &) = 0;
    virtual void Print(OPS_Stream &, int = 0) = 0;

  private:
    int tag;
    Domain *domain = nullptr;
};

class Element : public DomainComponent {
  public:
    Element(int tag, int) : DomainComponent(tag) {}
    virtual int getNumExternalNodes() const = 0;
    virtual const ID &getExternalNodes() = 0;
    virtual Node **getNodePtrs() = 0;
    virtual int getNumDOF() = 0;
    virtual int commitState() { return 0; }
    virtual int revertToLastCommit() = 0;
    virtual int revertToStart() { return 0; }
    virtual int update() { return 0; }
    virtual const Matrix &getTangentStiff() = 0;
    virtual const Matrix &getInitialStiff() = 0;
    virtual const Vector &getResistingForce() = 0;
};

extern "C" int OPS_GetIntInput(int *count, int *data);
extern "C" const char *OPS_GetString();
