/* surface.h - parametric surfaces P(u,v), 0 <= u,v <= 1, oriented so that N = Pu x Pv points outward or
   up.

   One file each (plane.h, torus.h, ...), listed in surface_list.h. Object space; lengths in scene
   units; angles of parametrisation are whole turns, phi = 2 pi u. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrSurfaceData WrSurfaceData;

#define WR_SURFACE_VALUES 48 /* numbers that describe a surface; a bicubic patch needs 16 points */
#define WR_SURFACE_PARAMS 6
#define WR_SURFACE_TEXTS 3
#define WR_SURFACE_TEXT_MAX 4000 /* bytes of each */
/* scene units; |N|^2 stays within double's range for lengths between the two */
#define WR_LENGTH_MIN 1e-30
#define WR_LENGTH_MAX 1e30

typedef enum WrSurfaceKind {
#define WR_X(name) WR_SURFACE_##name,
#include "surface/surface_list.h"
    WR_SURFACE_COUNT
} WrSurfaceKind;

/* A surface with its numbers: the values of its row's params, consecutively. Compared byte by byte;
   wr_shape_default initialises all bytes. */
typedef struct WrShape {
    WrSurfaceKind kind;
    double value[WR_SURFACE_VALUES];
    const WrSurfaceData
        *data;    /* computed from its texts (surface/data.h), borrowed; NULL: its row has none */
    uint64_t key; /* key of the data; distinguishes other data at the same address */
    double scale; /* factor of lengths in the data: 1 outside the renderer */
} WrShape;

/* Positions of a mesh's values, after its params: centre and radius of its bounding sphere (0: the unit
 * square), halves of its key. */
enum { WR_MESH_CENTRE = 40, WR_MESH_RADIUS = 43, WR_MESH_KEY = 44 };

/* A shape in single precision, scaled for the renderer. */
typedef struct WrShapef {
    float value[WR_SURFACE_VALUES];
    const WrSurfaceData *data;
    uint64_t key;
    float scale;
} WrShapef;

/* All quantities of the formulas at one point. N is not unit, as in the paper. Where N = 0, n_unit is
   the limiting normal: sphere's poles (0,0,-1) and (0,0,1); cone's apex the normal of that u's
   generator; torus the direction away from the tube's centre line; bezier by the rules in bezier.h;
   (0,0,1) where there is none. n_u, n_v are the limits of its derivatives (bezier: 0). On the inner
   part of a spindle torus (R < r) N is opposite to n_unit; everywhere else N = |N| n_unit. Never NaN
   for shapes that wr_shape_check accepts. */
typedef struct WrSurfacePoint {
    WrVec3 p, pu, pv, puu, puv, pvv;
    WrVec3 n, n_unit; /* N = Pu x Pv; N/|N| or its limit */
    WrVec3 n_u, n_v;  /* derivatives of n_unit: (N_u - n (n.N_u)) / |N| in closed form */
    double n_len;     /* |N| */
} WrSurfacePoint;
typedef struct WrSurfacePointf {
    WrVec3f p, pu, pv, puu, puv, pvv, n, n_unit, n_u, n_v;
    float n_len;
} WrSurfacePointf;

/* The range of u and v on a face: 0..1, or a separate cell, so that (u,v) determine the face. */
typedef struct WrSurfaceCell {
    double u0, u1, v0, v1;
} WrSurfaceCell;
#define WR_CELL_MARGIN                                                                             \
    (1.0 / 32) /* between a face and its cell's border, as a fraction of a cell: two texels of 64 */

/* The renderer's method to find (u,v) of a ray's hit. */
typedef enum WrInversion {
    WR_INVERT_MESH, /* refined mesh, then Newton's method: works for every surface */
    WR_INVERT_PLANE,
    WR_INVERT_SPHERE,
    WR_INVERT_CYLINDER,
    WR_INVERT_CONE,
    WR_INVERT_CUBE,
    WR_INVERT_TRIANGLES /* rasterisation of the scene's triangles */
} WrInversion;
#define WR_INVERSIONS (WR_INVERT_TRIANGLES + 1)

typedef struct WrSurfaceParam {
    const char *name; /* as in commands: "R"; NULL ends the list */
    int components;   /* 1: a number; 3: a vector; 48: sixteen points, u index fastest */
    double fallback[WR_SURFACE_VALUES]; /* the default */
    double low, high;                   /* closed range of each component */
    bool length;      /* scales with the object (false: a count, an angle, a fraction) */
    const char *help; /* a few words, with the unit */
    const char
        *ends[2]; /* labels of low and high in the window, if these are the only values; or NULL */
} WrSurfaceParam;

/* A text parameter of a surface. */
typedef struct WrSurfaceText {
    const char *name;     /* as in commands: "profile"; NULL ends the list */
    const char *label;    /* in the window */
    const char *fallback; /* the default */
    const char *help;
    const char *shape; /* syntax, for help: "r,z;..." */
} WrSurfaceText;

typedef struct WrSurfaceInfo {
    const char *name, *label, *help;
    WrSurfaceParam params[WR_SURFACE_PARAMS];
    WrSurfaceText texts[WR_SURFACE_TEXTS];
    bool (*make)(WrSurfaceData *data,
                 WrError *err); /* computes the data from data->text; NULL without texts */
    double pose_deg[3];         /* rotation x, y, z of a good first view */
    double centre[3];           /* centre of rotations: a constant plus ... */
    bool centre_half_ab;        /* ... (a/2, b/2, 0) if this is set (plane, bent) */
    bool closed_u, closed_v;    /* P has period 1: replication should be an integer */
    bool open;                  /* an open sheet: its back is visible after half a turn */
    int faces;                  /* 1; cube 6, each with its own (u,v) */
    bool flat;                  /* shape operator 0 everywhere: blinn is exact */
    bool unit_sized;            /* fixed size (curl): not rescaled by the renderer */
    bool endless;       /* may extend beyond 0..1, if its value after a and b is above 0 (plane) */
    bool convex_closed; /* a closed convex body: front faces hide everything else */
    bool held; /* a mesh: the scene's triangles define its points, and whether it is closed */
    WrInversion inversion;
    /* The point and all derivatives, in double. face is 0..faces-1. */
    void (*at)(const WrShape *shape, int face, double u, double v, WrSurfacePoint *out);
    WrSurfaceCell (*cell)(const WrShape *shape, int face); /* NULL: 0..1 */
    /* Rejects numbers without a valid surface (a fold, a zero size); may be NULL. */
    bool (*check)(const WrShape *shape, WrError *err);
    /* Radius of the bounding sphere about the centre; NULL: found by sampling. */
    double (*radius)(const WrShape *shape);
    /* Positions where Pv may jump, 0 < v < 1: their number, at most `most`; NULL: only at quarters. */
    int (*corners)(const WrShape *shape, double *v, int most);
} WrSurfaceInfo;

extern const WrSurfaceInfo *const wr_surfaces[WR_SURFACE_COUNT];

int wr_surface_find(const char *name); /* kind, or -1 */
void wr_shape_default(WrSurfaceKind kind,
                      WrShape *shape); /* every param and text at its fallback */
/* Index of param `name` in shape->value, or -1. */
int wr_surface_param_offset(WrSurfaceKind kind, const char *name);
/* Checks ranges, finiteness and the surface's own rule. */
bool wr_shape_check(const WrShape *shape, WrError *err);
WrVec3 wr_shape_centre(const WrShape *shape);
/* Radius of a sphere about the centre that contains the whole surface. > 0; 1 if the surface is one
   point at the centre (a patch whose points are all equal). */
double wr_shape_radius(const WrShape *shape);
WrSurfaceCell wr_surface_cell(const WrShape *shape, int face);
/* True if it extends beyond u, v 0..1, up to WR_ENDLESS in each direction. Beyond that, float cannot
 * represent a position within the table. */
bool wr_shape_endless(const WrShape *shape);
#define WR_ENDLESS 0x1p20
/* The reason against displacement by a table, or NULL if it is supported. */
const char *wr_shape_unmoved(const WrShape *shape);
/* The reason against parallax mapping, or NULL if it is supported. */
const char *wr_shape_without_parallax(const WrShape *shape);
/* Number of cells beside and above one another, if each face has its own; else 1, 1. */
void wr_surface_cells(const WrShape *shape, int *columns, int *rows);
/* The face whose cell contains (u,v), including its margin; `face` if all faces have the same cell. */
int wr_surface_face(const WrShape *shape, int face, double u, double v);
/* Evaluates a point; asserts kind and face. u, v: 0..1; slightly outside is allowed (Newton's steps). */
void wr_surface_at(const WrShape *shape, int face, double u, double v, WrSurfacePoint *out);
/* Converts the shape to single precision with all lengths multiplied by `scale` (a power of two; 1 for
   unit_sized surfaces). Values beyond float's range become its largest. */
void wr_shape_scaled(const WrShape *shape, double scale, WrShapef *out);
