/* blend.h - table of blend modes, which combine a layer's heights with those below. Works on texels only,
   without layers and documents. A new mode is one function over spans and one row of wr_blends.

   With b the height below, h the layer's height, o its opacity, m its mask, c its coverage, k the radius of the
   smooth modes:

     add        b + o m h                 subtract   b - o m h
     max, min   b + w (max(b,h) - b)      replace    b + w (h - b)           w = o m c
     multiply   b + w (b h - b)           mix        b + o m (h - b)
     smooth-max b + w (max(b,h) + s s k/4 - b),  s = max(k - |b - h|, 0) / k
     smooth-min b + w (min(b,h) - s s k/4 - b)

   All in float, with one rounding per operation in the order of blend.c, so the bits are the same on every
   processor. A result is between b and the result of weight 1, exactly b at weight 0 and exactly that at weight
   1; beyond +-FLT_MAX it is +-FLT_MAX. Where h - b exceeds float's range, every weight above 0 counts as 1. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef enum WrBlend {
    WR_BLEND_ADD,
    WR_BLEND_SUBTRACT,
    WR_BLEND_MAX,
    WR_BLEND_MIN,
    WR_BLEND_SMOOTH_MAX,
    WR_BLEND_SMOOTH_MIN,
    WR_BLEND_REPLACE,
    WR_BLEND_MIX,
    WR_BLEND_MULTIPLY,
    WR_BLEND_COUNT
} WrBlend;

/* Blends h[i] onto b[i] with weight w[i] (0..1), in place; radius k >= 0 in height units. h and b finite; the
   three arrays do not overlap. */
typedef void (*WrBlendSpan)(size_t count, const float *h, const float *w, float radius, float *b);

typedef struct WrBlendMode {
    const char *name;  /* name in commands: "smooth-max" */
    const char *label; /* name in the window: "Smooth maximum" */
    const char *help;  /* one line */
    bool uses_radius;  /* true for the smooth modes */
    bool uses_cover;   /* w = o m c; else w = o m */
    bool takes;        /* weight 1 yields exactly h, independent of the height below */
    float neutral;     /* a height that leaves b's bits unchanged at every weight; NaN: none */
    WrBlendSpan span;
} WrBlendMode;

extern const WrBlendMode wr_blends[WR_BLEND_COUNT];

/* Modes by which a ramp can be combined with existing heights, in the order of its argument's words. */
#define WR_RAMP_BLENDS 4
extern const WrBlend wr_ramp_blends[];

/* The mode of that name, or -1. */
int wr_blend_find(const char *name);

/* One tile of a layer, or any other run of texels. A NULL array has its level everywhere. Values of cover and
   mask outside 0..1 are clamped. */
typedef struct WrBlendTile {
    const float *heights; /* finite */
    float level;
    const float *cover; /* coverage of the layer; ignored unless the mode uses_cover */
    float cover_level;
    const float *mask;
    float mask_level;
} WrBlendTile;

/* Blends `count` texels onto `below`, in place.

   mode     0..WR_BLEND_COUNT - 1
   opacity  0..1 (clamped, NaN is 0); exactly 0 leaves every bit below
   radius   k of the smooth modes, height units; 0, negative and NaN give the plain maximum or minimum below
   [count] finite heights below, then the result, finite */
void wr_blend_tile(WrBlend mode, float opacity, float radius, const WrBlendTile *tile, size_t count,
                   float *below);

/* Blends onto heights that cover only a part, in place: `cover` is the coverage of `below`. Where it is 0, the layer's
   height itself is the result; between, the usual rule of colours with alpha. With weight w (o m c; of mix: o m) and
   coverage a below:

     a' = a + w (1 - a)    b' = b + (w / a') (t - b),   t = (1 - a) h + a blend(h, b) at weight 1

   add and subtract change b as above, whatever a is. Where a = 1, b' has the bits of wr_blend_tile.

   on_ground: nothing is below; then add uses h for b, as mix does
   cover    [count] 0..1 below, then of both */
void wr_blend_tile_partial(WrBlend mode, bool on_ground, float opacity, float radius,
                           const WrBlendTile *tile, size_t count, float *below, float *cover);
