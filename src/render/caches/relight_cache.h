/* relight_cache.h - what light looks at of the samples of a resting view, so that a change of light or material alone works out
   light alone (E76): n' and P, where pictures are looked up also u and v, and what shadows, footprints and widened
   highlights go by. They are noted when such a change comes for the first time: a view that turns, or that an edit
   reaches, never pays for it. Besides, how much each sample sees of each lamp, while that lamp stays. All as light finds
   it, before an object is stretched, in kernel units (view.h). Of several objects each sample has the numbers of the one
   that it shows.
   Layer 5, private to the renderer. */
#pragma once
#include "render/plan/plan.h"
#include "scene/objects.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrKernels WrKernels;

/* What a frame does with it. */
typedef enum WrRelightUse {
    WR_RELIGHT_NONE, /* nothing */
    WR_RELIGHT_NOTE, /* it is filled */
    WR_RELIGHT_KNOWN /* it is used */
} WrRelightUse;

/* Numbers of a sample, as the strips have them. */
typedef enum WrRelightGroup {
    WR_RELIGHT_BENT,     /* n' */
    WR_RELIGHT_POINTS,   /* P */
    WR_RELIGHT_PLACES,   /* u, v: of pictures, of shadows and occlusion by the relief */
    WR_RELIGHT_NORMALS,  /* n: of shadows and footprints */
    WR_RELIGHT_TANGENTS, /* Pu, Pv: of shadows by the relief and footprints */
    WR_RELIGHT_SPREAD,   /* how slopes spread in the plane across n', and along which direction */
    WR_RELIGHT_TRIANGLE, /* which of a mesh's it is: of shadows */
    WR_RELIGHT_GROUPS
} WrRelightGroup;
#define WR_RELIGHT_BIT(group) (1U << (group))
#define WR_RELIGHT_EACH 24 /* numbers of all groups */

/* What a frame shows of an object but for its light. */
typedef struct WrRelightPart {
    const WrScene *scene; /* of the object alone */
    const WrPlan *plan;
    uint64_t field; /* the table's key (wr_field_key) */
    int object;     /* its place among the scene's */
} WrRelightPart;

/* All that it shows. */
typedef struct WrRelightView {
    const WrRelightPart *parts; /* [count], above 0 */
    int count;
    const WrKernels *kernels;
    double turn_deg;
    int width, height; /* samples */
} WrRelightView;

#define WR_RELIGHT_BLOCK 64 /* samples beside each other */
/* Bytes that are kept at most, of a view of up to 2048 x 2048 pixels with a shadow; larger ones have nothing kept. */
#define WR_RELIGHT_MOST ((size_t)384000000)
#define WR_RELIGHT_MOST_TEXT "384 MB"

/* How much each sample sees of a lamp. */
typedef struct WrRelightShare {
    WrLight lamp; /* whose: but for colour and strength */
    bool cast;    /* past objects; else over the relief's horizon */
    int fine;     /* rays to a round lamp, or directions of horizons */
    bool used;    /* by the frame at hand */
    float *of;    /* [height][width], 0..1; below 0: not known yet. Owned by WrRelight */
} WrRelightShare;

/* The shares of a lamp that shines; NULL: they are not kept. */
typedef struct WrRelightLamp {
    /* `of` of shares, not owned; a sample's is written by the thread that draws its tile */
    float *cast, *relief;
} WrRelightLamp;

/* Zero-initialise; fini frees. */
typedef struct WrRelight {
    /* Of the last frame that it suits; its parts are those below; count 0: there was none. */
    WrRelightView view;
    WrRelightPart
        *parts;      /* [count], owned, with shares of their scenes and copies of their plans */
    unsigned groups; /* bits of those that are noted */
    int each;        /* numbers of a sample */
    /* [height][blocks of a row][each][WR_RELIGHT_BLOCK], the groups' in their order, so that a row of a tile is read in one
       piece. Groups that a sample's own object does not ask for hold anything. Owned; NULL: nothing is noted */
    float *numbers;
    /* [height][width]: which object a sample shows, 1 + its place among the scene's; 0: nothing. Owned */
    unsigned char *owner;
    WrRelightShare *shares; /* [share_count], owned */
    int share_count;
    WrRelightLamp *lamps; /* of the view's (view.h), in their order; owned. NULL: none is hidden */
    bool whole;           /* each sample was noted */
    WrRelightUse use;     /* of the frame at hand */
    char told[120];       /* what becomes of it, for the plan's row */
} WrRelight;

_Static_assert(WR_OBJECTS_MAX < 255, "an owner is a byte");

static inline size_t wr_relight_place(const WrRelight *steady, int x, int y)
{
    return (size_t)y * (size_t)steady->view.width + (size_t)x;
}

/* Where the numbers of the sample at x, y are: WR_RELIGHT_BLOCK apart; then those beside it up to the next multiple of that. */
static inline size_t wr_relight_at(const WrRelight *steady, int x, int y)
{
    const int blocks = (steady->view.width + WR_RELIGHT_BLOCK - 1) / WR_RELIGHT_BLOCK;
    const size_t block = (size_t)y * (size_t)blocks + (size_t)(x / WR_RELIGHT_BLOCK);
    return block * (size_t)steady->each * WR_RELIGHT_BLOCK + (size_t)(x % WR_RELIGHT_BLOCK);
}

void wr_relight_fini(WrRelight *steady);
/* Why light alone cannot be worked out of such numbers, or NULL. */
const char *wr_relight_hinders(const WrScene *scene, const WrPlan *plan);
/* The groups that light of that plan looks at. */
unsigned wr_relight_groups(const WrScene *scene, const WrPlan *plan);
/* Bytes that a view's numbers, and its lamps' shares, come to. */
size_t wr_relight_bytes(const WrRelightView *view);
/* The use of it to a frame that it suits and that draws every tile: known where it differs from the last one in light
   at most, noted where it does so for the first time. Without memory there is none. Who has noted every tile sets `whole`;
   until then it is noted again. view: only for the call; scenes are shared, plans copied. */
WrRelightUse wr_relight_bring(WrRelight *steady, const WrRelightView *view);
