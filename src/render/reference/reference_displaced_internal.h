/* reference_displaced_internal.h - sheets, boxes and edges shared by the files of reference_displaced.h. Private
   to them. */
#pragma once
#include "render/reference/reference_displaced.h"

/* Floats, rounded outwards. */
typedef struct WrRaisedBox {
    float low[3], high[3];
    /* of a cell: largest sine of the angle between its normals and the middle one; 2: unknown */
    float sine;
} WrRaisedBox;

typedef enum WrRaisedKind {
    WR_RAISED_FACE,
    /* along an edge: its first parameter follows the edge, its second leads across */
    WR_RAISED_STRIP,
    WR_RAISED_CORNER /* of three faces: the parallelogram between two strips' ends */
} WrRaisedKind;

/* An edge of a face: 0 v lowest, 1 v highest, 2 u lowest, 3 u highest. */
typedef struct WrRaisedEdge {
    int face, side;
    bool back; /* it runs in the opposite direction */
} WrRaisedEdge;

#define WR_RAISED_LEVELS 24
struct WrRaisedSheet {
    WrRaisedKind kind;
    WrSurfaceCell domain;    /* of its parameters */
    WrRaisedEdge edge, mate; /* a strip's own edge, and the one that it connects to */
    int face;
    double u, v;             /* a corner's position ... */
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
/* Converts the sheet's parameters to a position on the surface. */
void wr_raised_place(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                     double v, WrReferenceHit *hit);

/* ---- reference_displaced_edges.c ---- */

/* Finds strips and corners where sheets separate: at most WR_RAISED_JOINTS into out; returns their number. */
#define WR_RAISED_JOINTS 128
int wr_raised_joints(const WrReferenceRaised *raised, WrRaisedSheet out[WR_RAISED_JOINTS]);
/* As wr_raised_at, for strips and corners. */
void wr_raised_joint_at(const WrReferenceRaised *raised, const WrRaisedSheet *sheet, double u,
                        double v, WrRaisedPoint *out);
/* u and v of the patch at t, 0..1, along an edge. */
void wr_raised_edge_at(const WrReferenceRaised *raised, WrRaisedEdge edge, double t, double *u,
                       double *v);
