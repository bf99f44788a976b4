/* dials.h - the dials of accuracy: every approximation that a picture may make, as a setting of the scene.
   One table, wr_dials: the command's arguments, the scene's lines, the ladder that
   `wrinkle accuracy` climbs and the window's Accuracy panel are all made from it. A new dial is one
   member of WrDials (or of the scene) and one row. */
#pragma once
#include <stdbool.h>

typedef struct WrText WrText;

typedef struct WrScene WrScene;

/* How a pixel's samples become one intensity. */
typedef enum WrAntialias {
    WR_AA_POINT,   /* one sample at the pixel's centre */
    WR_AA_FILTER,  /* one sample of F filtered over the pixel's footprint: Blinn 1978 section 5.
                          Right mean slope, wrong intensity: it does not converge */
    WR_AA_MOMENTS, /* mean slope turns n'; the spread of slopes widens the highlight: Toksvig, LEAN.
                          Diffuse light is that of the mean slope */
    WR_AA_SUPERSAMPLE, /* mean of K x K intensities: the paper's correct solution */
    WR_AA_ADAPTIVE,    /* K x K only where needed */
    WR_AA_COUNT
} WrAntialias;

/* filter, moments: the shape of a pixel's footprint in the table: the parallelogram of one pixel's steps to
   the right and down. Up to one texel the table itself is looked up, by the scene's scheme, with the bits of
   `point`; above, box means of central differences, whatever the scheme (render/textures/slope_pyramid.h). */
typedef enum WrFootprint {
    WR_FOOTPRINT_ISOTROPIC,   /* a square of the longer side: one look-up between two mip levels */
    WR_FOOTPRINT_ANISOTROPIC, /* up to 16 look-ups of the shorter side along the longer */
    WR_FOOTPRINT_COUNT
} WrFootprint;

/* moments: the model of how slopes spread inside the footprint. C is their covariance as tangents of angles
   about n'. The program's lobe cos^s is taken for the Gaussian exp(-s tan^2 / 2), whose mean over Gaussian
   slopes is again one; the result is written as a cosine's power, so that C = 0 gives the bits of `point`:
     lean      (det(I + s C))^(-1/2) cos^s',  s' = t^T (C + I/s)^-1 t for the direction t from n' to h
     toksvig   (1 + s c)^-1 cos^(s / (1 + s c)),  c = trace(C) / 2
   Within 8 % of the peak for Gaussian slopes; slopes that are not Gaussian (bricks) may come out worse than
   with `filter`. */
typedef enum WrMoments {
    WR_MOMENTS_TOKSVIG, /* the isotropic form: one variance */
    WR_MOMENTS_LEAN, /* mean and covariance, Olano and Baker 2010, Sigma = M - B B^T, kept centred */
    WR_MOMENTS_COUNT
} WrMoments;

/* supersample, adaptive: where in the pixel the samples stand. */
typedef enum WrSpread {
    WR_SPREAD_REGULAR, /* centres of K x K cells */
    WR_SPREAD_JITTERED, /* one anywhere in each cell, from an integer hash of the pixel and the cell */
    WR_SPREAD_COUNT
} WrSpread;

/* adaptive: what decides that a pixel needs more. */
typedef enum WrRefine {
    /* One sample a pixel; where light bends evenly about it, the mean over the pixel follows from that sample and
       its neighbours. Where third differences say that this may be off by more than `contrast`, along every outline
       and where a pixel holds more than two texels: of K x K first K, one in each row and column, where 4 divides K
       and places are regular; the others too unless each of those is as the neighbours told, to a few times
       `contrast`, and their mean to once. An estimate: what falls between the samples is missed. Where a few blocks
       of the view tell that more would be taken than spared, all are taken at once. */
    WR_REFINE_CONTRAST,
    /* K x K but where a bound on the intensity's change over the pixel is within `contrast`: then no pixel is
       farther from that of K x K than `contrast`. A bound is known on plane, cube and sphere with slopes by
       central or nearest, normal none or blinn, without a colour picture; elsewhere all take K x K. */
    WR_REFINE_BOUND,
    WR_REFINE_COUNT
} WrRefine;

/* What a height is stored as when it is looked up; slopes and spline coefficients are made from that. The
   rungs of fewer bits are looked up as rounded numbers in single precision: their error is measured, not a
   store's price. Pyramids hold single precision. */
typedef enum WrHeights {
    WR_HEIGHTS_DOUBLE, /* look-ups in double; slopes and coefficients not rounded to single precision */
    WR_HEIGHTS_FLOAT,
    WR_HEIGHTS_HALF, /* IEEE binary16, ties to even, at most 65504 */
    WR_HEIGHTS_16,   /* integers over the table's own range, as in a 16-bit file */
    WR_HEIGHTS_8,
    WR_HEIGHTS_COUNT
} WrHeights;

typedef enum WrShading {
    WR_SHADING_FLOAT,
    WR_SHADING_DOUBLE,
    WR_SHADING_HALF, /* n', v, l, n'.l, the sums of light and the colour are kept as binary16 between stages */
    WR_SHADING_COUNT
} WrShading;

typedef enum WrArithmetic {
    WR_ARITHMETIC_EXACT, /* the same bits on every processor */
    WR_ARITHMETIC_FAST, /* contraction, reciprocal square roots by estimate and a step, on AVX2 and AVX-512:
                            each stage within 2e-4 of the exact one, of 1 or of the value if that is larger;
                            not of `double` shading */
    WR_ARITHMETIC_COUNT
} WrArithmetic;

/* Zero is not the default of all: see wr_dials_default. */
typedef struct WrDials {
    WrAntialias aa;
    int samples; /* supersample: K of K x K; adaptive: the most; 1..64 */
    WrSpread spread;
    WrFootprint footprint;
    WrMoments moments;
    WrRefine refine;
    double contrast; /* adaptive: how far from K x K, linear intensity, 0..1 */
    int mesh;        /* -4..4: curved surfaces' grid is 2^mesh times as fine each way */
    int newton;      /* most steps of the inversion, 0..8; -1: as many as the mesh calls for */
    double texels; /* the inversion stops where its step is shorter than so many texels; 0: never */
    int horizons;  /* directions in which the relief's horizons are kept: 4..64 */
    int rays;      /* to a round lamp that objects may hide; 0: they hide none; 0..256 */
    double dice;   /* pixels: so near are a displaced surface's facets to it; 1/16..16 */
    int steps;     /* parallax: most of a ray on its way to the relief; 4..1024 */
    WrHeights heights;
    WrShading shading;
    WrArithmetic arithmetic;
    int harmonics; /* order up to which diffuse light of surroundings is kept: 0..2 */
    double gloss;  /* texels over the width of a lobe that surroundings are blurred by: 4..128 */
    double faint;  /* linear: a lamp's highlight of facets below this is left out: 0..0.1 */
} WrDials;

WrDials wr_dials_default(void);
/* What documents start with where a person looks at them: 2 x 2 samples, so that edges are no stairs. */
void wr_dials_smooth(WrDials *dials);

typedef enum WrDialId {
    WR_DIAL_SCHEME, /* the scene's scheme and bump mode are dials as well, set by `bump` */
    WR_DIAL_NORMAL,
    WR_DIAL_AA,
    WR_DIAL_SAMPLES,
    WR_DIAL_SPREAD,
    WR_DIAL_FOOTPRINT,
    WR_DIAL_MOMENTS,
    WR_DIAL_REFINE,
    WR_DIAL_CONTRAST,
    WR_DIAL_MESH,
    WR_DIAL_NEWTON,
    WR_DIAL_TEXELS,
    WR_DIAL_ENERGY,
    WR_DIAL_HARMONICS,
    WR_DIAL_GLOSS,
    WR_DIAL_FAINT,
    WR_DIAL_HORIZONS,
    WR_DIAL_RAYS,
    WR_DIAL_DICE,
    WR_DIAL_STEPS,
    WR_DIAL_HEIGHTS,
    WR_DIAL_SHADING,
    WR_DIAL_ARITHMETIC,
    WR_DIAL_COUNT
} WrDialId;

/* The ladder's axes. */
typedef enum WrAxis {
    WR_AXIS_DERIVATIVE,
    WR_AXIS_NORMAL,
    WR_AXIS_ANTIALIASING,
    WR_AXIS_VISIBILITY,
    WR_AXIS_LIGHT,
    WR_AXIS_ARITHMETIC,
    WR_AXIS_COUNT
} WrAxis;
extern const char *const wr_axis_labels[WR_AXIS_COUNT]; /* "derivative of F", ... */

typedef struct WrDial {
    const char *name;    /* as the argument's: "footprint" */
    const char *command; /* that sets it: "bump" or "dials" */
    WrAxis axis;
    const char *label, *help; /* for people; help is a few words, with the unit */
    int choices;              /* how many rungs by name; 0: a number */
    const char *(*choice)(int rung);
    double low, high; /* of a number */
    bool whole;
    bool sparse; /* printed only where it is not the default: older programs do not know it */
    double (*get)(const WrScene *scene); /* the rung's index, or the number */
    void (*set)(WrScene *scene, double value);
    /* Whether the dial can change the scene's picture as its other dials stand (footprint: only with filter
       or moments); NULL: always. */
    bool (*matters)(const WrScene *scene);
    /* The rungs that the ladder tries, of a number; ends with NAN; NULL: every choice. */
    const double *rungs;
} WrDial;

extern const WrDial wr_dials[WR_DIAL_COUNT];

/* "aa=supersample samples=4 ...", the members of one command that differ from the default, in the
   table's order; all of them when `all`. */
void wr_dials_print(const WrScene *scene, const char *command, bool all, WrText *text);
