/* frame_internal.h - renderer state that is kept between frames.
   Private to frame.c, the other frame_*.c files and multi_object.c. */
#pragma once
#include "field/horizon.h"
#include "render/textures/ambient_occlusion.h"
#include "render/frame/pixel_encode.h"
#include "render/tessellation/dice.h"
#include "render/shadows/shadow_rays.h"
#include "render/frame/frame.h"
#include "render/caches/dirty_regions.h"
#include "render/environment/env_setup.h"
#include "render/textures/slope_pyramid.h"
#include "render/textures/mips.h"
#include "render/textures/height_copies.h"
#include "render/frame/tile.h"

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
    WrHeightBounds bounds; /* slope bounds for parallax ... */
    WrParallax parallax;   /* ... and the last frame's parallax parameters, for picking */
    WrSphereRows balls[WR_VIEW_GRIDS];
    WrLook look;
    WrLookd look_double;
    /* the field fetched by this frame: the request's, or its quantized heights */
    const WrField *looked;
    /* mesh: of the last frame; the others: of frames with `hold` */
    WrViewMesh meshes[WR_HELD_MESHES], *mesh;
    WrViewTriangles triangles; /* of a mesh file */
    WrTriangles *square; /* replacement shown while the scene's mesh is missing; owned; or NULL */
    /* facets of a displaced surface: the source of `triangles`; and those kept for the other kind of view */
    WrDice dice, dice_aside;
    bool dice_moving; /* `dice` is for moving views */
    WrColorMips tint, facets[WR_FACET_KINDS];
    WrNormalMips relief;
    WrEnvLookup mirror;
    WrEnvPrefilter grades; /* the environment prefiltered at several roughness levels */
    WrHorizon horizon;     /* of the table with this key, times this sign */
    uint64_t horizon_key;
    double horizon_sign;
    WrField *horizon_field; /* own share of that table */
    /* [its height][its width]: texels whose horizon the last edit changed (wr_horizon_update), and the key of
       the table before that edit. Owned; NULL: the horizons were computed from scratch */
    unsigned char *horizon_edit;
    uint64_t horizon_before;
    WrOcclusionMapTable opening;
    WrShadowRaysBody body; /* the object as a shadow caster */
    WrShadowRays cast;     /* objects that can hide lamps from it */
    WrFrames frames;
    WrUvCache uv_cache;              /* of the last static view */
    WrRelight own_relight, *relight; /* relight cache of a static view: its own, or its group's */
    WrTileScratch **scratch;         /* [threads], allocated on first use */
    int threads;
    float *rgba;         /* the last picture, or its last band, as floats ... */
    uint32_t *codes;     /* ... or as codes; each is allocated on first use */
    WrBackdrop backdrop; /* background of the codes */
    uint32_t bins[WR_CODE_BINS + 1];
    int width, height;
    int top, rows; /* rows of the picture that rgba holds */
    int room;      /* rows that rgba has memory for */
    bool banded;   /* rgba is a band */
    WrPlan plan;
    WrView view; /* of the last frame, for picking */
    WrScene *scene;
    double pyramid_seconds; /* time that it spent on pyramids */
    int samples;
    WrShape sized; /* the shape that the cached radius belongs to; 0: none */
    double radius;
    bool seen;          /* view and scene are set */
    bool uv_cached;     /* `uv_cache` holds this view */
    bool uses_uv_cache; /* this frame reads or fills `uv_cache` */
    bool outside;       /* the eye of that view is outside the surface */
    bool stands;        /* the planned view equals the last one */
    WrDirty keep;
    WrPlanRequest ask;   /* inputs of this frame's plan */
    WrFrameRequest last; /* of the last whole or refreshed picture; only its numbers are valid */
    const WrKernels *kernels; /* of this frame once prepared; before, of the last one */
    const WrWide *wide;       /* fused SIMD kernels of this frame; or NULL */
    int64_t covered;
    WrGroup *group; /* of several objects; NULL: none yet. Owned */
    int among;      /* for a part of a group: number of shown objects; else 0 */
};

/* The tiles of a frame: of one object, or of several, whose jobs are in drawing order. */
typedef struct FrameJob {
    WrTileJob tile;              /* with several objects: the target of the pixels */
    const WrTileJob *objects;    /* [count]; NULL: `tile` is the one object's */
    const WrDirty *const *keeps; /* [keep_count]: render only tiles that their changes touch ... */
    int count, keep_count;       /* ... 0: all */
    WrTileScratch **scratch;
    int tiles_u;
    const unsigned char *only; /* as in WrFrameRequest */
    const volatile int *cancel;
} FrameJob;

/* A picture of several objects (multi_object.c): each object is a part, a renderer of its own that borrows this
   one's threads, scratch memory and picture. */
bool wr_group_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                    WrError *err);
bool wr_group_pick(WrRenderer *renderer, double x, double y, int *object, double *u, double *v,
                   int *face);
void wr_group_free(WrRenderer *renderer);

/* ---- frame.c ---- */

/* Allocates the requested picture; for a part of a group, sets only its size. */
bool wr_frame_resize(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
/* Calls in this order: decide builds the plan of a frame of one object and the tables it needs; then
   wr_frame_choose_relight_cache; then prepare builds everything else needed before the tiles. False on error. */
bool wr_frame_decide(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
bool wr_frame_prepare(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
/* Next call: the uv cache is reused from the last frame, or filled where every tile is new. beside: hash of the
   other objects of the picture, 0: there are none. */
void wr_frame_update_visibility(WrRenderer *renderer, const WrFrameRequest *request, WrHash beside,
                                bool anew);
/* Decides whether the relight cache serves this frame of `count` objects (relight_cache.h). Plan rows that
   depend on it are decided again in each object's renderer. */
void wr_frame_choose_relight_cache(WrRenderer *renderer, const WrFrameRequest *request,
                                   const WrRelightPart *parts, WrRenderer *const *owners,
                                   int count);
/* Prepares the dirty-region record of each tile of the picture. */
void wr_frame_start_notes(const WrTileJob *canvas, WrDirty *keep);
/* Binds uv cache and relight cache to the job: to read them or to fill them. */
void wr_frame_fill_uv_cache(WrRenderer *renderer, WrTileJob *job);
/* A job with target and size of the tiles. request NULL: for picking. */
WrTileJob wr_frame_canvas(WrRenderer *renderer, const WrFrameRequest *request);
/* A job with target, tile size and everything that tiles fetch. */
WrTileJob wr_frame_job(WrRenderer *renderer, const WrFrameRequest *request);
/* Marks the picture as up to date with the table. */
void wr_frame_mark_current(WrRenderer *renderer);
int wr_frame_tiles(const WrTileJob *tile); /* tiles of the picture */
/* Renders the tiles. False if cancelled. */
bool wr_frame_run(WrRenderer *renderer, FrameJob *job);
/* True if an edit may be answered by re-rendering only the tiles that fetched the edited texels: the request
   allows it and no edit reaches farther. */
bool wr_frame_may_keep(const WrFrameRequest *request);
/* True if both request the same output: codes over the same background with the same tone, or both floats. */
bool wr_frame_same_output(const WrFrameCodes *a, const WrFrameCodes *b);
void wr_renderer_forget(
    WrRenderer *renderer); /* frees all caches, except the threads' scratch memory */

/* Decides, builds the tables that the decision needs, and decides again once the gradient table is known. ask:
   its facts about the table are filled in. */
bool wr_frame_prepare_table(WrRenderer *renderer, const WrFrameRequest *request, WrPlanRequest *ask,
                            WrError *err);
bool wr_frame_prepare_maps(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
void wr_frame_drop_tables(WrRenderer *renderer);
/* Updates the table's horizons, and its ambient occlusion, where the plan uses them. Errors: no memory;
   cancelled. */
bool wr_frame_update_horizon(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
bool wr_frame_update_occlusion(WrRenderer *renderer, const WrFrameRequest *request, WrError *err);
void wr_frame_drop_horizon(WrRenderer *renderer);
/* Fills the fetch parameters of tiles; scale: object units -> kernel units. */
void wr_frame_fill_looks(const WrRenderer *renderer, const WrFrameRequest *request, double scale,
                         WrTileJob *job);
/* Start sets each thread's counters to 0; account adds them to the frame and the plan's rows. */
void wr_frame_start_counts(WrRenderer *renderer);
void wr_frame_account(WrRenderer *renderer, double prepared, double started, WrFrame *frame);
/* Frees all view meshes except one, which may be NULL. */
void wr_frame_drop_meshes(WrRenderer *renderer, const WrViewMesh *but);
/* The triangles that the scene shows, owned by the renderer or by the scene. */
const WrTriangles *wr_frame_triangles(WrRenderer *renderer, const WrScene *scene);
/* Finds the occluders of each of a picture's `count` objects, each with its renderer. Errors: as
   wr_shadow_rays_prepare. */
bool wr_frame_casts(WrRenderer *const *renderers, const WrScene *const *scenes,
                    const WrField *const *fields, int count, const WrFrameRequest *request,
                    WrError *err);
/* The triangles in the form that kernels fetch. */
WrTriangleLook wr_frame_look_up(const WrViewTriangles *triangles, double scale);
/* Updates the mesh that the surface is rasterised from for this view. Errors: no memory. */
bool wr_frame_prepare_meshes(WrRenderer *renderer, const WrFrameRequest *request,
                             const WrKernels *kernels, WrError *err);
