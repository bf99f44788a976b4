/* reference.h - reference renderer, the picture that the accuracy benchmark measures against. Double precision from
   end to end, written separately from the fast path and without its kernels.

   F        the scene's formula if it has one; else the cubic B-spline through the table's samples, with
            coefficients in double, whatever the scene's scheme is.
   Normal   exact (Blinn 1978 before the small-F approximation); invariant if the scene selects it,
            which is another model and not an approximation; none only if the scene has no height.
   Inverse  closed forms for plane, cube, sphere, cylinder, cone; else subdivision with Newton's method in
            double until the step is below 1e-12 of the patch, nearest root.
   Shape    P + F n if the surface is displaced, by Newton's method on it: no facets (reference_relief.h).
   Pixels   the mean of k x k intensities, summed in pairs; k is doubled until the change from k to 2k is
            below a tenth of the error to be measured, or the limit is reached.
   Shading  by the scene's lights and material, in double, with the C library's pow. */
#pragma once
#include "render/plan/plan.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

typedef struct WrReferenceRequest {
    const WrField *field; /* borrowed for the call; may be NULL if the scene's F is a formula */
    const WrField *const *fields; /* of the scene's objects, as in WrFrameRequest */
    const WrScene *scene;         /* its dials are ignored */
    int width, height;            /* pixels, 1..4096 each */
    double turn_deg;
    int first; /* initial samples a side; a power of two, 1..64; 0: 4 */
    /* final limit, first..64; 0: 32, for displaced surfaces 16. k is always a power of two */
    int most;
    /* converged when doubling changes less than this, RMS of linear intensity over the covered pixels; 0:
       continue to `most` */
    double change_rms;
    /* Blocks of WR_FRAME_BLOCK pixels to render, as in WrFrameRequest; NULL: all. */
    const unsigned char *only;
    const volatile int *cancel;
} WrReferenceRequest;

typedef struct WrReference {
    int width, height;
    double *rgba; /* [height][width][4] linear, premultiplied, A coverage; owned */
    /* n' at the pixel's centre, unit, object space, facing the viewer; 0,0,0 outside the object;
       [height][width][3]; owned */
    double *normal;
    int samples; /* k of the k x k samples in rgba */
    /* change by the last doubling, RMS over covered pixels; NAN if there was none ... */
    double last_rms;
    double last_max; /* ... and its maximum */
    bool converged;  /* last_rms is below change_rms, or 0 */
    double seconds;  /* wall time */
    int64_t lost; /* samples whose inversion did not converge: counted; the nearest root is used */
} WrReference;

/* Renders the reference. Zero-initialise *out; it may be reused. pool may be NULL. Same bits for any number of
   threads. */
bool wr_reference_render(const WrReferenceRequest *request, WrPool *pool, WrReference *out,
                         WrError *err);
void wr_reference_fini(WrReference *reference);

/* All quantities of the formulas at one point of the picture (the pixel inspector). */
typedef struct WrProbe {
    bool hit;
    double u, v;
    int face;
    WrSurfacePoint at; /* P, Pu, Pv, N, n, n_u, n_v */
    double f, fu, fv;  /* with height and replication */
    WrVec3 d, a;       /* D = Fu (n x Pv) - Fv (n x Pu); A = Fv Pu - Fu Pv */
    WrVec3 perturbed;  /* n', unit, by the formulas: on back faces it points away from the viewer */
    WrVec3 perturbed_exact; /* by the exact formula, including the term that the paper omits */
    double tilt_deg;        /* between n and n' */
    double dropped_deg;     /* between the paper's n' and the exact one */
    /* The pixel's footprint in the table, texels, y downwards: dx/dX, dy/dX, dx/dY, dy/dY; limited to +-1e9,
       which it reaches along outlines and at poles. */
    double footprint[4];
    double level;  /* log2 of its longer side; 0 if that is below a texel */
    int samples;   /* K by the scene's dials there (adaptive: the maximum) */
    double rgb[3]; /* linear intensity at this point */
} WrProbe;

/* Inspects a point. x, y: pixels from the top left corner of a picture of that size. F and slopes by the scene's
   own scheme and bump mode, in double. False and an error only for an invalid camera. */
bool wr_reference_probe(const WrField *field, const WrScene *scene, int width, int height,
                        double turn_deg, double x, double y, WrProbe *out, WrError *err);

/* Map of one quantity over the picture, [height][width] floats, NAN outside the object. */
typedef enum WrProbeMap {
    WR_MAP_DROPPED, /* dropped_deg: error of the small-F approximation */
    WR_MAP_TILT,    /* tilt_deg */
    WR_MAP_LEVEL,   /* level */
    WR_MAP_HEIGHT,  /* f */
    /* perturbed, as 65536 r + 256 g + b with the codes 127.5 + 127.5 c of its x, y and z */
    WR_MAP_NORMAL,
    WR_MAP_COUNT
} WrProbeMap;
bool wr_reference_map(const WrField *field, const WrScene *scene, int width, int height,
                      double turn_deg, WrProbeMap map, WrPool *pool, const volatile int *cancel,
                      float *out, WrError *err);
