/* reference.h - the picture that the ladder measures against: double precision from end to end, written
   apart from the fast path and sharing no kernel with it.
   Layer 5.

   F        the scene's formula where it has one; else the cubic B-spline through the table's samples, its
            coefficients found in double. Whatever the scene's scheme says.
   Normal   exact (Blinn 1978 before the small-F approximation); invariant where the scene asks for it,
            which is another model and not an approximation; none only if the scene has no height.
   Inverse  closed forms for plane, cube, sphere, cylinder, cone; else subdivision with Newton's method in
            double until the step is under 1e-12 of the patch, nearest root.
   Shape    P + F n where the surface is displaced, by Newton's method on it: no facets (reference_displaced.h).
   Pixels   the mean of k x k intensities, summed in pairs; k is doubled until the change from k to 2k is
            under a tenth of the error to be measured, or the limit is reached.
   Shading  as the scene's lights and material say, in double, with the C library's pow. */
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
    const WrField *field; /* borrowed for the call; may be NULL where the scene's F is a formula */
    const WrField *const *fields; /* as in WrFrameRequest: of the scene's objects */
    const WrScene *scene;         /* its dials are not looked at */
    int width, height;            /* pixels, 1..4096 each */
    double turn_deg;
    int first; /* samples a side to begin with; a power of two, 1..64; 0: 4 */
    int most; /* and where to stop, first..64; 0: 32, of displaced surfaces 16. k stays at a power of two */
    double
        change_rms; /* converged when doubling changes less than this, RMS of linear intensity over
                          the covered pixels; 0: go on to `most` */
    /* Blocks of WR_FRAME_BLOCK pixels to do, as in WrFrameRequest; NULL: all. */
    const unsigned char *only;
    const volatile int *cancel;
} WrReferenceRequest;

typedef struct WrReference {
    int width, height;
    double *rgba; /* [height][width][4] linear, premultiplied, A coverage; owned */
    /* n' at the pixel's centre, unit, object space, towards the viewer's side; 0,0,0 where the object is
       not; [height][width][3]; owned */
    double *normal;
    int samples; /* k of k x k that rgba is made of */
    double
        last_rms; /* what the last doubling changed, RMS over covered pixels; NAN without one ... */
    double last_max; /* ... and at most */
    bool converged;  /* last_rms is under change_rms, or 0 */
    double seconds;  /* wall time */
    int64_t
        lost; /* samples whose inversion did not converge: counted, taken from the nearest root */
} WrReference;

/* Zero-initialise *out; it may be used again. pool may be NULL. Same bits for any number of threads. */
bool wr_reference_render(const WrReferenceRequest *request, WrPool *pool, WrReference *out,
                         WrError *err);
void wr_reference_fini(WrReference *reference);

/* Everything that the formulas hold at one place of the picture (the pixel inspector). */
typedef struct WrProbe {
    bool hit;
    double u, v;
    int face;
    WrSurfacePoint at; /* P, Pu, Pv, N, n, n_u, n_v */
    double f, fu, fv;  /* height and replication included */
    WrVec3 d, a;       /* D = Fu (n x Pv) - Fv (n x Pu); A = Fv Pu - Fu Pv */
    WrVec3 perturbed;  /* n', unit, by the formulas: from behind it points away from the viewer */
    WrVec3 perturbed_exact; /* of the exact formula, for the term that the paper drops */
    double tilt_deg;        /* between n and n' */
    double dropped_deg;     /* between the paper's n' and the exact one */
    /* The pixel's footprint in the table, texels, y downwards: dx/dX, dy/dX, dx/dY, dy/dY; within +-1e9,
       which it reaches along outlines and at poles. */
    double footprint[4];
    double level;  /* log2 of its longer side; 0 where it is under a texel */
    int samples;   /* K that the scene's dials take there (adaptive: at most) */
    double rgb[3]; /* linear intensity at this very point */
} WrProbe;

/* x, y: pixels from the top left corner of a picture of that size; F and slopes by the scene's own
   scheme and bump mode, in double. False and an error only for a camera that cannot look. */
bool wr_reference_probe(const WrField *field, const WrScene *scene, int width, int height,
                        double turn_deg, double x, double y, WrProbe *out, WrError *err);

/* The map of one quantity over the picture, [height][width] floats, NAN where the object is not. */
typedef enum WrProbeMap {
    WR_MAP_DROPPED, /* dropped_deg: what the small-F approximation leaves out */
    WR_MAP_TILT,    /* tilt_deg */
    WR_MAP_LEVEL,   /* level */
    WR_MAP_HEIGHT,  /* f */
    WR_MAP_NORMAL, /* perturbed, as 65536 r + 256 g + b of the codes 127.5 + 127.5 c of its x, y and z */
    WR_MAP_COUNT
} WrProbeMap;
bool wr_reference_map(const WrField *field, const WrScene *scene, int width, int height,
                      double turn_deg, WrProbeMap map, WrPool *pool, const volatile int *cancel,
                      float *out, WrError *err);
