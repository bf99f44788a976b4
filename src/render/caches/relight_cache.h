/* relight_cache.h - G-buffer of a static view; changing lights or materials re-runs only shading (E76). Private
   to the renderer.

   Per sample it stores n' and P; u and v where pictures are fetched; and the inputs of shadows, footprints and
   widened highlights. It is filled when such a change comes for the first time, so a view that turns or that an
   edit reaches never pays for it. It also stores the visibility of each lamp per sample while that lamp is
   unchanged. All values are as the shading stages read them, before an object is stretched, in kernel units
   (view.h). With several objects, each sample has the values of the object that it shows. */
#pragma once
#include "render/plan/plan.h"
#include "scene/objects.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrKernels WrKernels;

/* Use of the cache by a frame. */
typedef enum WrRelightUse {
    WR_RELIGHT_NONE, /* not used */
    WR_RELIGHT_NOTE, /* the frame fills it */
    WR_RELIGHT_KNOWN /* the frame reads it */
} WrRelightUse;

/* Groups of numbers per sample, in the layout of the strips. */
typedef enum WrRelightGroup {
    WR_RELIGHT_BENT,     /* n' */
    WR_RELIGHT_POINTS,   /* P */
    WR_RELIGHT_PLACES,   /* u, v: for pictures, and for shadows and occlusion by the relief */
    WR_RELIGHT_NORMALS,  /* n: for shadows and footprints */
    WR_RELIGHT_TANGENTS, /* Pu, Pv: for shadows by the relief, and for footprints */
    WR_RELIGHT_SPREAD,   /* spread of the slopes in the plane across n', and its direction */
    WR_RELIGHT_TRIANGLE, /* index of the mesh triangle: for shadows */
    WR_RELIGHT_GROUPS
} WrRelightGroup;
#define WR_RELIGHT_BIT(group) (1U << (group))
#define WR_RELIGHT_EACH 24 /* numbers of all groups */

/* State of one object's picture, apart from its light. */
typedef struct WrRelightPart {
    const WrScene *scene; /* with this object alone */
    const WrPlan *plan;
    uint64_t field; /* the table's key (wr_field_key) */
    int object;     /* index among the scene's objects */
} WrRelightPart;

/* All objects of a view. */
typedef struct WrRelightView {
    const WrRelightPart *parts; /* [count], above 0 */
    int count;
    const WrKernels *kernels;
    double turn_deg;
    int width, height; /* samples */
} WrRelightView;

#define WR_RELIGHT_BLOCK 64 /* samples in one block of a row */
/* Memory limit: a view of up to 2048 x 2048 pixels with one shadow fits; larger ones are not cached. */
#define WR_RELIGHT_MAX ((size_t)384000000)
#define WR_RELIGHT_MAX_TEXT "384 MB"

/* Visibility of one lamp at each sample. */
typedef struct WrRelightShare {
    WrLight lamp; /* the lamp; colour and strength are ignored */
    bool cast;    /* shadows of objects; else of the relief's horizon */
    int fine;     /* number of rays to an area lamp, or of horizon directions */
    bool used;    /* by the current frame */
    float *of;    /* [height][width], 0..1; below 0: not computed yet. Owned by WrRelight */
} WrRelightShare;

/* Visibility arrays of one enabled lamp; NULL: not cached. */
typedef struct WrRelightLamp {
    /* `of` of two shares, not owned. An element is written only by the thread that draws its tile. */
    float *cast, *relief;
} WrRelightLamp;

/* Zero-initialise; fini frees. */
typedef struct WrRelight {
    /* The view that the cache belongs to; its parts are those below. count 0: none. */
    WrRelightView view;
    /* [count], owned, with shares of their scenes and copies of their plans */
    WrRelightPart *parts;
    unsigned groups; /* bits of the groups that are stored */
    int each;        /* floats per sample */
    /* [height][blocks of a row][each][WR_RELIGHT_BLOCK], the groups in order, so that a row of a tile is read as
       one piece. Groups that a sample's own object does not need hold any values. Owned; NULL: nothing is stored */
    float *numbers;
    /* [height][width]: 1 + index of the object that the sample shows; 0: background. Owned */
    unsigned char *owner;
    WrRelightShare *shares; /* [share_count], owned */
    int share_count;
    /* of the view's lamps (view.h), in their order; owned. NULL: no lamp has a visibility cache */
    WrRelightLamp *lamps;
    bool whole;       /* every sample is stored */
    WrRelightUse use; /* by the current frame */
    char status[120]; /* status text for the plan's row */
} WrRelight;

_Static_assert(WR_OBJECTS_MAX < 255, "an owner is a byte");

static inline size_t wr_relight_place(const WrRelight *relight, int x, int y)
{
    return (size_t)y * (size_t)relight->view.width + (size_t)x;
}

/* Index of the numbers of sample x, y. They are WR_RELIGHT_BLOCK apart; samples to the right follow, up to the
   next multiple of that. */
static inline size_t wr_relight_at(const WrRelight *relight, int x, int y)
{
    const int blocks = (relight->view.width + WR_RELIGHT_BLOCK - 1) / WR_RELIGHT_BLOCK;
    const size_t block = (size_t)y * (size_t)blocks + (size_t)(x / WR_RELIGHT_BLOCK);
    return block * (size_t)relight->each * WR_RELIGHT_BLOCK + (size_t)(x % WR_RELIGHT_BLOCK);
}

void wr_relight_fini(WrRelight *relight);
/* Reason why the scene cannot be relit from stored numbers, or NULL. */
const char *wr_relight_hinders(const WrScene *scene, const WrPlan *plan);
/* The groups that shading reads under that plan. */
unsigned wr_relight_groups(const WrScene *scene, const WrPlan *plan);
/* Bytes of the numbers and of the lamps' shares of a view. */
size_t wr_relight_bytes(const WrRelightView *view);
/* Chooses the use of the cache for a frame that is supported and draws every tile: KNOWN if the frame differs
   from the last one only in light, NOTE if it does so for the first time. Without memory the cache is not used.
   The caller sets `whole` once every tile is stored; until then it is filled again. view: borrowed for the call;
   scenes are shared, plans copied. */
WrRelightUse wr_relight_update(WrRelight *relight, const WrRelightView *view);
