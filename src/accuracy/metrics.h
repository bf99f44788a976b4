/* metrics.h - error metrics of a picture against the reference.
   Linear intensity; R, G and B have equal weight. Sums in double, in pairs, in a fixed order. */
#pragma once
#include "render/reference/reference.h"

#include <stdint.h>

typedef struct WrErrors {
    int64_t pixels; /* of the picture */
    /* with coverage in either picture, edges included: the base of the next three */
    int64_t covered;
    double rms;     /* sqrt(mean over covered pixels and channels) */
    double max;     /* largest difference of a channel */
    double p999;    /* 99.9 percentile of the pixels' largest differences */
    double rms_all; /* over all pixels */
    int64_t edges;  /* pixels whose coverage is between 0 and 1 in either picture, or differs */
    double rms_inside, max_inside; /* over the covered pixels that are not edges */
    /* degrees, atan2(|a x b|, a.b), over pixels whose centres have a normal in both; NAN without normals */
    double angle_rms, angle_max, angle_p999;
    double coverage_rms, coverage_max; /* of A, over the edges; 0 without edges */
} WrErrors;

/* Measures a picture. rgba [h][w][4] linear premultiplied, as in WrFrame; normal [h][w][3] or NULL; both of the
   reference's size. only: as in the reference's request, or NULL. */
void wr_errors_measure(const float *rgba, const float *normal, const WrReference *reference,
                       const unsigned char *only, WrErrors *out);

/* A difference picture for display: 8-bit RGB [h][w][3], |difference| / full in the colour scale of the plots
   (black, violet, orange, white); full <= 0: the largest difference. */
void wr_errors_picture(const float *rgba, const WrReference *reference, double full, uint8_t *out);
/* That colour scale: t 0..1 -> 8-bit sRGB. */
void wr_heat_colour(double t, uint8_t rgb[3]);
