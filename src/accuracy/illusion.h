/* illusion.h - difference between bump mapping and true displacement, separated into outline, shading and
   shadow.

   B    the scene's objects bump mapped, without shadows of the relief
   D0   displaced, without shadows; facets within 1/8 pixel
   D    displaced, with shadows

   all with 4 x 4 samples a pixel. D - B is the sum of D - D0, the shadow, and D0 - B: the shading where both
   cover, the outline where one does. Objects whose F cannot displace their surface (mesh files) are equal in all
   three. */
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
    int64_t common;      /* pixels that all three cover fully: the base of rms */
    double outline;      /* square pixels: integral of |coverage of B - coverage of D| */
    double perimeter;    /* pixels: length of B's outline */
    double outline_mean; /* outline / perimeter, pixels; 0 without an outline */
    double hausdorff;    /* pixels: Hausdorff distance of the two outlines; NAN if there is none */
    double shading;      /* rms of D0 - B, linear intensity, at equal pixels ... */
    double shading_at;   /* ... and at equal u and v, by the reference */
    double shadow;       /* rms of D - D0 */
    double all;          /* rms of D - B */
    /* distance in pixels between a displaced point and its position with bump mapping: mean and largest */
    double way_mean, way;
    double rise;        /* largest displacement by F, in pixels; -1: unknown */
    double bump_height; /* of the current object: `bump height=` */
    float *map;         /* [height][width][3]: outline, shading, shadow of each pixel; owned */
} WrIllusion;

typedef struct WrIllusionRequest {
    const WrField *const *fields; /* as in WrFrameRequest; NULL: `field` for all objects */
    const WrField *field;
    const WrScene *scene;
    int width, height; /* 1..WR_ILLUSION_MAX each */
    double turn_deg;
    int threads; /* 0: all */
    const char *isa;
    const WrProgress *progress; /* may be NULL */
} WrIllusionRequest;
#define WR_ILLUSION_MAX 2048

/* Zero-initialise *out. Errors: those of frames and of the reference; nothing in the scene can be displaced. */
bool wr_illusion_measure(const WrIllusionRequest *request, WrIllusion *out, WrError *err);
void wr_illusion_fini(WrIllusion *illusion);
/* The map's pixel as a colour: red outline, green shading, blue shadow; a light difference of a tenth is full.
   pixel: row by row. */
void wr_illusion_colour(const WrIllusion *illusion, size_t pixel, uint8_t rgb[3]);
/* The height below which no difference is visible in this view, or that there is none. One sentence. */
void wr_illusion_height(const WrIllusion *illusion, WrText *text);
/* Conclusions: the height below which the difference is invisible, and its components. Up to five sentences. */
void wr_illusion_advice(const WrIllusion *illusion, WrText *text);
void wr_illusion_text(const WrIllusion *illusion, const char *name, WrText *text);
void wr_illusion_json(const WrIllusion *illusion, const char *name, WrText *text);
