/* frame.h - a picture of a field under a scene: plan, visibility, geometry, bump, shade, resolve.
   Layer 5. A renderer keeps caches (contiguous heights, gradient table, meshes) from frame to frame and
   brings them up to date from what changed; give each view its own. */
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

/* The picture as 8-bit sRGB over a background: a quarter of the memory, and each pixel is written once. */
typedef struct WrFrameCodes {
    bool wanted; /* instead of rgba */
    WrBackground background;
    WrTone tone;
    const WrScene
        *scene; /* whose surroundings and camera a background of surroundings shows; borrowed */
} WrFrameCodes;
/* As the scene says. */
WrFrameCodes wr_frame_codes_of(const WrScene *scene, bool wanted);

/* What a pixel took. */
typedef enum WrMapBit {
    WR_MAP_RENDERED = 1, /* its tile was rendered in this frame */
    WR_MAP_COVERED = 2,  /* a sample met the object */
    WR_MAP_LOOKED = 4,   /* a sample looked F up: bump ran */
    WR_MAP_WIDE = 8,     /* in the pyramid, or several times (E17); without bump: C so (E64) */
    WR_MAP_LIT = 16,     /* light was worked out: it does not lie on the dark side (E18) */
    WR_MAP_SAMPLES = 32 /* from here on: samples a side, 1, up to 2, 4, 8, ... as 0, 1, 2, 3, ... */
} WrMapBit;

typedef struct WrFrameRequest {
    const WrField *field; /* borrowed for the call */
    /* The tables of a scene's objects (objects.h), in their order, [objects]; NULL entries, and NULL: `field`. */
    const WrField *const *fields;
    const WrScene *scene;
    int width, height; /* pixels, 1..16384 each */
    /* A band of the picture: its rows [first, first + rows) alone, with the bits that they have in the
       whole; rows 0: all. `keep` is as false then, and there is no `only`. */
    int first, rows;
    double turn_deg;      /* turntable angle about the world's y axis */
    const WrDials *dials; /* NULL: the scene's */
    bool keep; /* the view rests: remember what each tile of the picture looks at, so that the
                             next frame of the same scene, turn, size and dials renders only the tiles
                             that an edit of the table reaches (E29); the bits are the same. Such a
                             frame does not look at `cancel` */
    bool hold; /* copies of the table that this frame does without are kept for the next, which is
                             known to want them: memory for time */
    /* Blocks of WR_FRAME_BLOCK x WR_FRAME_BLOCK pixels, [ceil(height / block)][ceil(width / block)]:
       those with 0 are not rendered, their pixels stay as this renderer's last picture of that size
       had them (0 in the first). NULL: all. */
    const unsigned char *only;
    /* n' at each pixel's centre, object space, towards the viewer's side, 0,0,0 where the object is not;
       [height or else rows][width][3], the caller's; NULL: not wanted. One sample a pixel is taken, whatever the
       dials say of supersampling. */
    float *normals;
    WrFrameCodes codes; /* 8-bit pixels instead of float ones */
    /* What each pixel took, bits of WrMapBit; [height or else rows][width], the caller's; pixels that are not rendered
       stay as they are: a view that rests gives the same memory each time, as it was left. NULL: not wanted. */
    uint8_t *map;
    /* Effects that run, or do not, whatever the scene calls for: [WR_EFFECT_COUNT]; NULL: none. */
    const WrForce *force;
    bool full; /* run whatever the plan could leave out without changing the picture */
    const volatile int *cancel; /* may be NULL; non-zero: return early, false, err "cancelled" */
} WrFrameRequest;

typedef struct
    WrStageTimes { /* seconds, summed over threads, but for `total`, which is wall time */
    double prepare, visibility, geometry, bump, shade, resolve, total;
    double pyramid; /* the part of `prepare` that pyramids of slopes took; wall time, as prepare */
} WrStageTimes;

typedef struct WrFrame {
    int width, height; /* a band's: its rows */
    int first, of;     /* the first of them among the rows of the picture, and how many that has */
    float *rgba; /* [height][width][4] linear, premultiplied; A is coverage; owned by the renderer,
                    valid until its next frame; NULL where codes were wanted */
    /* [height][width] opaque 0xAARRGGBB, on little-endian machines B,G,R,A in memory: the same codes as
       wr_frame_to_srgb8 makes of rgba; or NULL. The renderer's, as rgba. */
    const uint32_t *codes;
    int64_t not_finite; /* numbers that this frame made codes of: taken as 0 (HC96) */
    int64_t covered;    /* pixels with coverage > 0 */
    int64_t shaded;     /* samples shaded for this frame */
    WrStageTimes times;
    const WrPlan *plan; /* with what each effect cost; owned by the renderer, as rgba */
} WrFrame;

/* isa: NULL or "auto", else "ref", "v1" .. "v4"; NULL and an error for one that this processor lacks
   or that does not exist. pool is borrowed. The caller owns the renderer. */
WrRenderer *wr_renderer_new(WrPool *pool, const char *isa, WrError *err);
void wr_renderer_free(WrRenderer *renderer);
int wr_renderer_threads(const WrRenderer *renderer);
const char *wr_renderer_isa(const WrRenderer *renderer); /* as it was asked for */

/* Render. The bits depend on the request alone: not on threads, nor (arithmetic exact) on the isa or
   on what was rendered before: fast arithmetic rounds within its bound, and a light that is worked out alone (relight_cache.h)
   stands otherwise in its strips. */
bool wr_renderer_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                       WrError *err);

/* 8-bit sRGB, developed, over a background: bytes [height][width][channels], channels 3, or 4 with
   opaque alpha in memory order B,G,R,A when bgra. Non-finite counts as 0; returns how many (HC96). */
int64_t wr_frame_to_srgb8(const WrFrame *frame, const WrFrameCodes *how, bool bgra, uint8_t *out,
                          WrPool *pool);
/* The same with alpha, over nothing: bytes R,G,B,A, not premultiplied. */
int64_t wr_frame_to_alpha8(const WrFrame *frame, const WrTone *tone, uint8_t *out, WrPool *pool);

/* `count` of them as bytes R,G,B; out [count][3]. */
void wr_codes_to_rgb(const uint32_t *codes, size_t count, uint8_t *out);

/* The (u,v) under a pixel position (from the top left, pixels) of the last frame; false where the
   object is not. face: 0 but on the cube. */
bool wr_renderer_pick(WrRenderer *renderer, double x, double y, double *u, double *v, int *face);
/* The same, and which of the scene's objects it is that is seen there. */
bool wr_renderer_pick_object(WrRenderer *renderer, double x, double y, int *object, double *u,
                             double *v, int *face);
/* The number of the triangle there, of the scene's mesh; false where none is, or on another surface. */
bool wr_renderer_pick_triangle(WrRenderer *renderer, double x, double y, int32_t *triangle);
