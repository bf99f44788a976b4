/* dials.h - the dials of accuracy: settings of the scene for every approximation that a picture may
   make.

   One table, wr_dials, generates the command's arguments, the scene's lines, the accuracy benchmark of `wrinkle
   accuracy` and the window's Accuracy panel. A new dial is one member of WrDials (or of the scene) and
   one row. */
#pragma once
#include <stdbool.h>

typedef struct WrText WrText;

typedef struct WrScene WrScene;

/* Combination of a pixel's samples to one intensity. */
typedef enum WrAntialias {
    WR_AA_POINT,   /* one sample at the pixel's centre */
    WR_AA_FILTER,  /* one sample of F filtered over the pixel's footprint: Blinn 1978 section 5.
                      Right mean slope, wrong intensity: it does not converge */
    WR_AA_MOMENTS, /* the mean slope tilts n'; the variance of slopes widens the highlight: Toksvig,
                      LEAN. Diffuse light uses the mean slope */
    WR_AA_SUPERSAMPLE, /* mean of K x K intensities: the paper's correct solution */
    WR_AA_ADAPTIVE,    /* K x K only where needed */
    WR_AA_COUNT
} WrAntialias;

/* filter, moments: the shape of a pixel's footprint in the table: the parallelogram of one pixel's
   steps to the right and down. Up to one texel the table itself is sampled, by the scene's scheme, with
   the bits of `point`; above, box means of central differences, for every scheme
   (render/textures/slope_pyramid.h). */
typedef enum WrFootprint {
    WR_FOOTPRINT_ISOTROPIC,   /* a square of the longer side: one look-up between two mip levels */
    WR_FOOTPRINT_ANISOTROPIC, /* up to 16 look-ups of the shorter side along the longer */
    WR_FOOTPRINT_COUNT
} WrFootprint;

/* moments: the model of the distribution of slopes inside the footprint. C is their covariance as
   tangents of angles about n'. The program's lobe cos^s is approximated by the Gaussian exp(-s tan^2 /
   2), whose mean over Gaussian slopes is again a Gaussian; the result is written as a cosine's power,
   so that C = 0 yields the bits of `point`:
     lean      (det(I + s C))^(-1/2) cos^s',  s' = t^T (C + I/s)^-1 t for the direction t from n' to h
     toksvig   (1 + s c)^-1 cos^(s / (1 + s c)),  c = trace(C) / 2
   Within 8 % of the peak for Gaussian slopes; for other distributions (bricks) the result may be worse
   than with `filter`. */
typedef enum WrMoments {
    WR_MOMENTS_TOKSVIG, /* the isotropic form: one variance */
    WR_MOMENTS_LEAN, /* mean and covariance, Olano and Baker 2010, Sigma = M - B B^T, kept centred */
    WR_MOMENTS_COUNT
} WrMoments;

/* supersample, adaptive: positions of the samples in the pixel. */
typedef enum WrSpread {
    WR_SPREAD_REGULAR,  /* centres of K x K cells */
    WR_SPREAD_JITTERED, /* one at a random position in each cell, from an integer hash of the pixel
                           and the cell */
    WR_SPREAD_COUNT
} WrSpread;

/* adaptive: the criterion for more samples. */
typedef enum WrRefine {
    /* One sample per pixel; where light varies smoothly, the mean over the pixel follows from that
       sample and its neighbours. More samples are used if third differences predict an error above
       `contrast`, along every outline and where a pixel contains more than two texels: of K x K first
       K, one in each row and column, if 4 divides K and positions are regular; then the others, unless
       each of those agrees with the prediction from the neighbours to a few times `contrast`, and their
       mean to `contrast`. An estimate: details between the samples are missed. If a few blocks of the
       view predict that more would be sampled than saved, all samples are taken at once. */
    WR_REFINE_CONTRAST,
    /* K x K except where a bound of the intensity's change over the pixel is within `contrast`: then no
       pixel differs from K x K by more than `contrast`. A bound exists for plane, cube and sphere with
       slopes by central or nearest, normal none or blinn, without a colour picture; elsewhere all
       pixels use K x K. */
    WR_REFINE_BOUND,
    WR_REFINE_COUNT
} WrRefine;

/* Precision of stored heights; slopes and spline coefficients are computed from them. The settings of
   fewer bits are emulated as rounded numbers in single precision: their error is measured, not their
   memory cost. Pyramids use single precision. */
typedef enum WrHeights {
    WR_HEIGHTS_DOUBLE, /* look-ups in double; slopes and coefficients not rounded to single
                          precision */
    WR_HEIGHTS_FLOAT,
    WR_HEIGHTS_HALF, /* IEEE binary16, ties to even, at most 65504 */
    WR_HEIGHTS_16,   /* integers over the table's own range, as in a 16-bit file */
    WR_HEIGHTS_8,
    WR_HEIGHTS_COUNT
} WrHeights;

typedef enum WrShading {
    WR_SHADING_FLOAT,
    WR_SHADING_DOUBLE,
    WR_SHADING_HALF, /* n', v, l, n'.l, the sums of light and the colour are rounded to binary16
                        between stages */
    WR_SHADING_COUNT
} WrShading;

typedef enum WrArithmetic {
    WR_ARITHMETIC_EXACT, /* the same bits on every processor */
    WR_ARITHMETIC_FAST,  /* contraction, reciprocal square roots by estimate and one step, on AVX2
                           and AVX-512: each stage within 2e-4 of the exact one, relative to 1 or to
                           the value if that is larger; not with `double` shading */
    WR_ARITHMETIC_COUNT
} WrArithmetic;

/* Zero is not always the default: see wr_dials_default. */
typedef struct WrDials {
    WrAntialias aa;
    int samples; /* supersample: K of K x K; adaptive: the maximum; 1..64 */
    WrSpread spread;
    WrFootprint footprint;
    WrMoments moments;
    WrRefine refine;
    double contrast; /* adaptive: maximum difference from K x K, linear intensity, 0..1 */
    int mesh;   /* -4..4: the grid of curved surfaces is 2^mesh times as fine in each direction */
    int newton; /* maximum steps of the inversion, 0..8; -1: chosen for the mesh */
    double
        texels;   /* the inversion stops when its step is shorter than this many texels; 0: never */
    int horizons; /* directions in which the relief's horizons are stored: 4..64 */
    int rays;     /* to a round lamp that objects may hide; 0: no shadows between objects; 0..256 */
    double dice;  /* pixels: maximum distance of a displaced surface's facets from it; 1/16..16 */
    int steps;    /* parallax: maximum steps of a ray to the relief; 4..1024 */
    WrHeights heights;
    WrShading shading;
    WrArithmetic arithmetic;
    int harmonics; /* maximum order of the surroundings' diffuse light: 0..2 */
    double gloss;  /* texels over the width of the lobe that blurs surroundings: 4..128 */
    double faint;  /* linear: a lamp's facet highlight below this is skipped: 0..0.1 */
} WrDials;

WrDials wr_dials_default(void);
/* The dials of new documents in the window: 2 x 2 samples, so that edges are smooth. */
void wr_dials_smooth(WrDials *dials);

typedef enum WrDialId {
    WR_DIAL_SCHEME, /* the scene's scheme and bump mode are dials too, set by `bump` */
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

/* The accuracy benchmark's axes. */
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
    const char *command; /* command that sets it: "bump" or "dials" */
    WrAxis axis;
    const char *label, *help; /* for people; help is a few words, with the unit */
    int choices;              /* number of named choices; 0: a number */
    const char *(*choice)(int rung);
    double low, high; /* of a number */
    bool whole;
    bool sparse; /* printed only if it is not the default: older programs do not support it */
    double (*get)(const WrScene *scene); /* the index of the choice, or the number */
    void (*set)(WrScene *scene, double value);
    /* True if the dial can change the scene's picture for the present values of the other dials
       (footprint: only with filter or moments); NULL: always. */
    bool (*matters)(const WrScene *scene);
    /* The values that the accuracy benchmark tries, for a number; ends with NAN; NULL: every choice. */
    const double *rungs;
} WrDial;

extern const WrDial wr_dials[WR_DIAL_COUNT];

/* "aa=supersample samples=4 ...", the members of one command that differ from the default, in the
   table's order; all of them when `all`. */
void wr_dials_print(const WrScene *scene, const char *command, bool all, WrText *text);
