/* reference_displaced_internal.h - what the files of reference_displaced.h share.
   Layer 5, private to them. */
#pragma once
#include "render/reference/reference_displaced.h"

/* Floats, rounded outwards. */
typedef struct WrRaisedBox {
    float low[3], high[3];
    float sine; /* of a cell: that its normals keep within of its middle one; 2: none is kept */
} WrRaisedBox;

typedef enum WrRaisedKind {
    WR_RAISED_FACE,
    WR_RAISED_STRIP, /* along an edge: its first parameter is along it, its second leads away */
    WR_RAISED_CORNER /* of three faces: the parallelogram between two strips' ends */
} WrRaisedKind;

/* An edge of a face: 0 v lowest, 1 v highest, 2 u lowest, 3 u highest. */
typedef struct WrRaisedEdge {
    int face, side;
    bool back; /* it runs against the other */
} WrRaisedEdge;

#define WR_RAISED_LEVELS 24
struct WrRaisedSheet {
    WrRaisedKind kind;
    WrSurfaceCell domain;    /* of its parameters */
    WrRaisedEdge edge, mate; /* a strip's own, and what it meets */
    int face;
    double u, v;             /* a corner's place ... */
    WrVec3 p, across, aside; /* ... and its parallelogram */
    int nu, nv, levels;
    WrRaisedBox *boxes[WR_RAISED_LEVELS]; /* [ceil(nu / 2^l) * ceil(nv / 2^l)]; owned */
};

typedef struct WrRaisedPoint {
    WrVec3 p, pu, pv;
} WrRaisedPoint;

/* The point there and its derivatives by the sheet's parameters. */
void wr_raised_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u, double v,
                  WrRaisedPoint *out);
/* Where that is on the surface. */
void wr_raised_place(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                     double v, WrReferenceHit *hit);

/* ---- reference_displaced_edges.c ---- */

/* Strips and corners where sheets part: at most `room` into out, and returns how many there are. */
#define WR_RAISED_JOINTS 128
int wr_raised_joints(const WrReferenceRaised *raised, WrRaisedSheet out[WR_RAISED_JOINTS]);
/* The same as wr_raised_at, of strips and corners. */
void wr_raised_joint_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                        double v, WrRaisedPoint *out);
/* u and v of the patch at t, 0..1, along an edge. */
void wr_raised_edge_at(const WrReferenceRaised *raised, WrRaisedEdge edge, double t, double *u,
                       double *v);
