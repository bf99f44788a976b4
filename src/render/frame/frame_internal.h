/* frame_internal.h - what a renderer holds from frame to frame.
   Layer 5, private to frame.c and its brothers, multi_object.c. */
#pragma once
#include "field/horizon.h"
#include "render/textures/ambient_occlusion.h"
#include "render/frame/pixel_encode.h"
#include "render/tessellation/dice.h"
#include "render/shadows/shadow_rays.h"
#include "render/frame/frame.h"
#include "render/caches/dirty_regions.h"
#include "render/visibility/sparse_hits.h"
#include "render/environment/env_prefilter.h"
#include "render/environment/env_lookup.h"
#include "render/textures/slope_pyramid.h"
#include "render/textures/normal_mips.h"
#include "render/textures/quantized_heights.h"
#include "render/frame/srgb_encode.h"
#include "render/textures/height_copies.h"
#include "render/frame/tile.h"
#include "render/textures/color_mips.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrGroup WrGroup;

#define WR_HELD_MESHES 5 /* for 1, 2, 4, 8 and 16 samples a side */

struct WrRenderer {
    WrPool *pool;
    char isa[8];
    WrTable table;
    WrPyramid pyramid, range; /* of slopes; of their least and largest values */
    WrQuantizedHeights rounded;
    WrNormalMipsBounds bounds; /* of what parallax looks up ... */
    WrParallax parallax;       /* ... and how the last frame did, for picking */
    WrSphereRows balls[WR_VIEW_GRIDS];
    WrLook look;
    WrLookd look_double;
    const WrField *looked; /* what this frame looks up: the request's field, or its rounded form */
    WrViewMesh meshes[WR_HELD_MESHES],
        *mesh;                 /* mesh: of the last frame; the others, of frames that hold */
    WrViewTriangles triangles; /* of a mesh out of a file */
    WrTriangles *square; /* what is shown of a scene whose mesh is not there; owned; or NULL */
    WrDice dice;         /* of a displaced surface: what `triangles` has */
    WrColorMips tint, facets[WR_FACET_KINDS];
    WrNormalMips relief;
    WrEnvLookup mirror;
    WrEnvPrefilter grades; /* the same by rungs */
    WrHorizon horizon;     /* of the table with this key, times this sign */
    uint64_t horizon_key;
    double horizon_sign;
    WrField *horizon_field; /* own share of that table */
    /* [its height][its width]: where the last edit changed the horizon (wr_horizon_update), and of which table it made this
       one. Owned; NULL: they were made anew */
    unsigned char *horizon_edit;
    uint64_t horizon_before;
    WrOcclusionMapTable opening;
    WrShadowRaysBody body; /* of the object, as it throws shadows */
    WrShadowRays cast;     /* what can hide lamps from it */
    WrFrames frames;
    WrSparseHits knots; /* of `mesh`, if they are known */
    WrUvCache sight;    /* of the last view that rested */
    WrRelight own_steady,
        *steady;             /* of one that rests but for its light: its own, or its group's */
    WrTileScratch **scratch; /* [threads], made on first use */
    int threads;
    float *rgba;         /* the last picture, or the last band of it ... */
    uint32_t *codes;     /* ... or the same as codes; each made when it is first wanted */
    WrBackdrop backdrop; /* what lies behind them */
    uint32_t bins[WR_CODE_BINS + 1];
    int width, height;
    int top, rows; /* of the picture: what rgba holds */
    int room;      /* rows that rgba has memory for */
    bool banded;   /* it is a band */
    WrPlan plan;
    WrView view; /* of the last frame, for picking */
    WrScene *scene;
    double pyramid_seconds; /* that it spent on pyramids */
    int samples;
    WrShape sized; /* whose radius this is; 0: of none */
    double radius;
    bool seen;     /* view and scene are set */
    bool sighted;  /* `sight` knows what it looks at */
    bool sighting; /* this frame uses or fills `sight` */
    bool outside;  /* the eye of that view is outside the surface */
    bool stands;   /* the view that this frame was decided for is the last one's */
    WrDirty keep;
    WrPlanAsk ask;            /* what this frame's plan was asked */
    WrFrameRequest last;      /* of the last whole or refreshed picture; for its numbers only */
    const WrKernels *kernels; /* of this frame, once it is prepared; then of the last */
    int64_t covered;
    WrGroup *group; /* of several objects; NULL: none yet. Owned */
    int among;      /* a part of a group: objects that are shown; else 0 */
};

/* A frame of tiles: of one object, or of several, whose jobs are in the order in which they are drawn. */
typedef struct FrameJob {
    WrTileJob tile;              /* of several objects: where pixels go */
    const WrTileJob *objects;    /* [count]; NULL: `tile` is the one object's */
    const WrDirty *const *keeps; /* [keep_count]: render only what their changes touch ... */
    int count, keep_count;       /* ... 0: all */
    WrTileScratch **scratch;
    int tiles_u;
    const unsigned char *only; /* WrFrameRequest's */
    const volatile int *cancel;
} FrameJob;

/* A picture of several objects (multi_object.c): each is a part, a renderer of its own that borrows this one's threads, scratch
   and picture. */
bool wr_group_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                    WrError *err);
bool wr_group_pick(WrRenderer *renderer, double x, double y, int *object, double *u, double *v,
                   int *face);
void wr_group_free(WrRenderer *renderer);

/* ---- frame.c ---- */

/* Memory for the picture that is asked for, or, of a part, its numbers alone. */
bool wr_frame_resize(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
/* The plan of a frame of one object, and the tables that it goes by; then wr_frame_choose_steady, then all else that it
   needs before its tiles. False where it cannot be. */
bool wr_frame_decide(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
bool wr_frame_prepare(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
/* Then, what its samples look at: known from the last frame, or noted where every tile is anew. beside: of the other
   objects of the picture, 0: there are none. */
void wr_frame_bring_sight(WrRenderer *renderer, const WrFrameRequest *request, WrHash beside,
                          bool anew);
/* Is what a resting view shows, but for its light, of use to this frame of `count` objects (relight_cache.h)? The rows that go by it
   are decided once more, in each of the objects' renderers. */
void wr_frame_choose_steady(WrRenderer *renderer, const WrFrameRequest *request,
                            const WrRelightPart *parts, WrRenderer *const *owners, int count);
/* Make ready for noting what each tile of the picture looks at. */
void wr_frame_start_notes(const WrTileJob *canvas, WrDirty *keep);
/* Both, as the frame's tiles find or fill them. */
void wr_frame_fill_sight(WrRenderer *renderer, WrTileJob *job);
/* Where its tiles go, and of what size they are; request NULL: for picking. */
WrTileJob wr_frame_canvas(WrRenderer *renderer, const WrFrameRequest *request);
/* The same, and what they look up. */
WrTileJob wr_frame_job(WrRenderer *renderer, const WrFrameRequest *request);
/* The picture shows the table as it is now. */
void wr_frame_shown(WrRenderer *renderer);
int wr_frame_tiles(const WrTileJob *tile); /* of the picture */
/* Render the tiles. False if told to stop. */
bool wr_frame_run(WrRenderer *renderer, FrameJob *job);
/* May an edit be answered by the tiles alone that look at what it wrote? The request asks for it, and no edit reaches farther. */
bool wr_frame_may_keep(const WrFrameRequest *request);
/* Are both wanted as the same codes: over the same background, by the same tone? Or is neither? */
bool wr_frame_same_output(const WrFrameCodes *a, const WrFrameCodes *b);
void wr_renderer_forget(
    WrRenderer *renderer); /* all that a renderer holds but its threads' scratch */

/* Decide, make what the decision needs, and decide again once the gradient table is known. ask: its facts of the
   table are filled in. */
bool wr_frame_prepare_table(WrRenderer *renderer, const WrFrameRequest *request, WrPlanAsk *ask,
                            WrError *err);
bool wr_frame_prepare_maps(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
void wr_frame_drop_tables(WrRenderer *renderer);
/* The table's horizons, and how open it is there, where the plan goes by them. Errors: no memory; cancelled. */
bool wr_frame_bring_horizon(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
bool wr_frame_bring_opening(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
void wr_frame_drop_horizon(WrRenderer *renderer);
/* What tiles look up; scale: object units -> kernel units. */
void wr_frame_fill_looks(const WrRenderer *renderer, const WrFrameRequest *request, double scale,
                         WrTileJob *job);
/* Start each thread's counts at 0; then what they came to, into the frame and the plan's rows. */
void wr_frame_start_counts(WrRenderer *renderer);
void wr_frame_account(WrRenderer *renderer, double prepared, double started, WrFrame *frame);
/* All grids but one, which may be NULL. */
void wr_frame_drop_meshes(WrRenderer *renderer, const WrViewMesh *but);
/* Do the frame's tiles go by where the view sees one sheet of the mesh (sparse_hits.h), if there is memory? */
bool wr_frame_ties(const WrRenderer *renderer);
/* Bring that, and let the job go by it; without, it goes by what was noted only if that is all. */
void wr_frame_bind_sparse_hits(WrRenderer *renderer, WrTileJob *job);
/* The triangles that the scene shows; the renderer's, or the scene's. */
const WrTriangles *wr_frame_triangles(WrRenderer *renderer, const WrScene *scene);
/* What can hide lamps from each of `count` objects, those of a picture, each with its renderer. Errors: as wr_shadow_rays_prepare. */
bool wr_frame_casts(WrRenderer *const *renderers, const WrScene *const *scenes,
                    const WrField *const *fields, int count, const WrFrameRequest *request,
                    WrError *err);
/* As kernels look them up. */
WrTriangleLook wr_frame_look_up(const WrViewTriangles *triangles, double scale);
/* Bring what the surface is rasterised from up to the view. Errors: no memory. */
bool wr_frame_prepare_meshes(WrRenderer *renderer, const WrFrameRequest *request,
                             const WrKernels *kernels, WrError *err);
