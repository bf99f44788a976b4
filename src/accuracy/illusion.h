/* illusion.h - how far bump mapping is from the displacement that it imitates: outline, shading and shadow apart.
   Layer 6.

   B    the scene's objects bump mapped, without shadows of the relief
   D0   displaced, without shadows; facets within 1/8 pixel
   D    displaced, with shadows

   all by 4 x 4 samples a pixel. D - B is the sum of D - D0, the shadow, and D0 - B: the shading where both cover, the outline
   where one does. Objects whose F cannot move their surface (meshes out of files) are the same in all three. */
#pragma once
#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrProgress WrProgress;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

typedef struct WrIllusion {
    int width, height;   /* pixels */
    int64_t common;      /* pixels that all three cover whole: what rms is over */
    double outline;      /* square pixels: the integral of |coverage of B - that of D| */
    double perimeter;    /* pixels: of B's outline */
    double outline_mean; /* outline / perimeter: pixels; 0 without an outline */
    double hausdorff;    /* pixels: of the two outlines; NAN where there is none */
    double shading;      /* rms of D0 - B, linear intensity, at the same pixel ... */
    double shading_at;   /* ... and at the same u and v, by the reference */
    double shadow;       /* rms of D - D0 */
    double all;          /* rms of D - B */
    double way_mean,
        way; /* pixels between where a place is seen and where bump shows it: mean and largest */
    double rise;        /* pixels that F could move a point, at most; -1: not known */
    double bump_height; /* of the object at hand: `bump height=` */
    float *map;         /* [height][width][3]: outline, shading, shadow of each pixel; owned */
} WrIllusion;

typedef struct WrIllusionRequest {
    const WrField *const *fields; /* as in WrFrameRequest; NULL: `field` is that of all objects */
    const WrField *field;
    const WrScene *scene;
    int width, height; /* 1..WR_ILLUSION_MOST each */
    double turn_deg;
    int threads; /* 0: all */
    const char *isa;
    const WrProgress *progress; /* may be NULL */
} WrIllusionRequest;
#define WR_ILLUSION_MOST 2048

/* Zero-initialise *out. Errors: those of frames and of the reference; nothing in the scene that could be displaced. */
bool wr_illusion_measure(const WrIllusionRequest *request, WrIllusion *out, WrError *err);
void wr_illusion_fini(WrIllusion *illusion);
/* The map's pixel as a colour: red outline, green shading, blue shadow; of light a tenth is full. pixel: row by row. */
void wr_illusion_colour(const WrIllusion *illusion, size_t pixel, uint8_t rgb[3]);
/* Below which height nobody sees a difference in this view; or that nobody does. One sentence. */
void wr_illusion_height(const WrIllusion *illusion, WrText *text);
/* What follows: below which height nobody sees the difference, and what it is made of. Up to five sentences. */
void wr_illusion_advice(const WrIllusion *illusion, WrText *text);
void wr_illusion_text(const WrIllusion *illusion, const char *name, WrText *text);
void wr_illusion_json(const WrIllusion *illusion, const char *name, WrText *text);
