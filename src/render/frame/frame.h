/* frame.h - renderer of one frame: plan, visibility, geometry, bump, shading, resolve.

   A renderer keeps caches (contiguous heights, gradient table, meshes) between frames and updates them from the
   changes. Use one renderer for each view. */
#pragma once
#include "render/plan/plan.h"
#include "scene/background.h"
#include "scene/tone_mapping.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrDials WrDials;
typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

typedef struct WrRenderer WrRenderer;

#define WR_FRAME_BLOCK 8 /* pixels */

/* 8-bit sRGB output over a background: a quarter of the memory of floats, and each pixel is written once. */
typedef struct WrFrameCodes {
    bool wanted; /* instead of rgba */
    WrBackground background;
    WrTone tone;
    /* source of surroundings and camera for an environment background; borrowed */
    const WrScene *scene;
} WrFrameCodes;
/* Codes with the background and tone of the scene. */
WrFrameCodes wr_frame_codes_of(const WrScene *scene, bool wanted);

/* Flags of the per-pixel cost map. */
typedef enum WrMapBit {
    WR_MAP_RENDERED = 1, /* the tile was rendered in this frame */
    WR_MAP_COVERED = 2,  /* a sample hit the object */
    WR_MAP_LOOKED = 4,   /* a sample fetched F: bump ran */
    /* a fetch used the pyramid, or several texels (E17); without bump: of C (E64) */
    WR_MAP_WIDE = 8,
    WR_MAP_LIT = 16, /* light was computed: the pixel is not on the dark side (E18) */
    /* this bit and higher: log2 of samples a side: 1, up to 2, 4, 8, ... are 0, 1, 2, 3, ... */
    WR_MAP_SAMPLES = 32
} WrMapBit;

typedef struct WrFrameRequest {
    const WrField *field; /* borrowed for the call */
    /* [objects] tables of the scene's objects (objects.h), in their order; a NULL entry, and NULL itself, mean
       `field`. */
    const WrField *const *fields;
    const WrScene *scene;
    int width, height; /* pixels, 1..16384 each */
    /* A band of the picture: only its rows [first, first + rows), with the same bits as in the whole picture.
       rows 0: all. With a band `keep` is ignored and `only` must be NULL. */
    int first, rows;
    double turn_deg;      /* turntable angle about the world's y axis */
    const WrDials *dials; /* NULL: the scene's */
    /* Static view: record the fetches of each tile, so that the next frame of the same scene, turn, size and
       dials renders only the tiles that an edit of the table reaches (E29). The bits are the same. Such a frame
       ignores `cancel`. */
    bool keep;
    /* The view moves: a displaced surface has coarser facets, which are kept for other views of the same scale
       (dice.h). */
    bool moving;
    /* Keep table copies that this frame does not use, because the next one is known to need them: memory for
       time. */
    bool hold;
    /* Blocks of WR_FRAME_BLOCK x WR_FRAME_BLOCK pixels, [ceil(height / block)][ceil(width / block)]: blocks with
       0 are not rendered and keep the pixels of this renderer's last picture of that size (0 in the first).
       NULL: all. */
    const unsigned char *only;
    /* Output of n' at each pixel's centre: object space, facing the viewer, 0,0,0 outside the object. [height,
       or rows of a band][width][3], owned by the caller; NULL: none. One sample a pixel is taken, regardless of
       supersampling. */
    float *normals;
    WrFrameCodes codes; /* 8-bit pixels instead of float ones */
    /* Output of each pixel's cost, bits of WrMapBit. [height, or rows of a band][width], owned by the caller.
       Pixels that are not rendered are not written, so a static view passes the same memory each time. NULL:
       none. */
    uint8_t *map;
    /* Effects to force on or off, whatever the scene needs: [WR_EFFECT_COUNT]; NULL: none. */
    const WrForce *force;
    bool full; /* run even the effects that the plan could leave out without changing the picture */
    bool staged; /* without the fused SIMD kernels (simd_kernels.h), to measure their gain */
    const volatile int *cancel; /* may be NULL; non-zero: return early, false, err "cancelled" */
} WrFrameRequest;

typedef struct WrStageTimes { /* seconds, summed over threads; `total` is wall time */
    double prepare, visibility, geometry, bump, shade, resolve, total;
    double pyramid; /* part of `prepare` spent on slope pyramids; wall time, as prepare */
} WrStageTimes;

typedef struct WrFrame {
    int width, height; /* of a band: its rows */
    int first, of;     /* first row in the picture, and the picture's row count */
    /* [height][width][4] linear, premultiplied; A is coverage. Owned by the renderer, valid until its next
       frame. NULL where codes were requested. */
    float *rgba;
    /* [height][width] opaque 0xAARRGGBB, on little-endian machines B,G,R,A in memory: the same codes as
       wr_frame_to_srgb8 makes of rgba; or NULL. Owned by the renderer, as rgba. */
    const uint32_t *codes;
    /* non-finite numbers converted to codes in this frame; they count as 0 (HC96) */
    int64_t not_finite;
    int64_t covered; /* pixels with coverage > 0 */
    int64_t shaded;  /* samples shaded for this frame */
    WrStageTimes times;
    const WrPlan *plan; /* with the cost of each effect; owned by the renderer, as rgba */
} WrFrame;

/* isa: NULL or "auto", else "ref", "v1" .. "v4". NULL and an error for one that this processor lacks or that
   does not exist. pool is borrowed. The caller owns the renderer. */
WrRenderer *wr_renderer_new(WrPool *pool, const char *isa, WrError *err);
void wr_renderer_free(WrRenderer *renderer);
int wr_renderer_threads(const WrRenderer *renderer);
const char *wr_renderer_isa(const WrRenderer *renderer); /* as requested */

/* Renders a frame. The bits depend on the request alone: not on threads, and with exact arithmetic neither on
   the isa nor on earlier frames. Fast arithmetic rounds within its bound, and relighting (relight_cache.h) packs
   strips differently. */
bool wr_renderer_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                       WrError *err);

/* Converts to 8-bit sRGB, tone-mapped, over a background: bytes [height][width][channels], channels 3, or 4 with
   opaque alpha in memory order B,G,R,A if bgra. Non-finite counts as 0; returns how many there were (HC96). */
int64_t wr_frame_to_srgb8(const WrFrame *frame, const WrFrameCodes *how, bool bgra, uint8_t *out,
                          WrPool *pool);
/* Converts to bytes R,G,B,A, not premultiplied, without background. Non-finite counts as 0; returns how many
   there were. */
int64_t wr_frame_to_alpha8(const WrFrame *frame, const WrTone *tone, uint8_t *out, WrPool *pool);

/* Converts `count` codes to bytes R,G,B; out [count][3]. */
void wr_codes_to_rgb(const uint32_t *codes, size_t count, uint8_t *out);

/* Picks the (u,v) under a pixel position (pixels from the top left) of the last frame; false outside the object.
   face: 0 except on the cube. */
bool wr_renderer_pick(WrRenderer *renderer, double x, double y, double *u, double *v, int *face);
/* Picks (u,v), face and the index of the scene's object at that position. */
bool wr_renderer_pick_object(WrRenderer *renderer, double x, double y, int *object, double *u,
                             double *v, int *face);
/* Picks the triangle of the scene's mesh at that position; false outside it, or on another surface. */
bool wr_renderer_pick_triangle(WrRenderer *renderer, double x, double y, int32_t *triangle);
