/* document.h - document model: layers of heights, a selection and a scene. Plain data. Only a session
   (command/session.h) changes a document. */
#pragma once
#include "base/hash.h"
#include "document/blend.h"
#include "field/ops.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

#define WR_LAYERS_MAX 256     /* maximum layers of a document */
#define WR_LAYER_NAME_MAX 255 /* maximum bytes of a layer's name */
#define WR_DEPTH_MAX 8        /* maximum groups that a layer is in, one in another */

/* One layer. A filter's own heights are empty: it contributes the result of its operation on the composite of
   the layers below, which is updated incrementally. A generator layer keeps the command line that its heights and
   coverage come from; they are generated again when the line changes, or the layers below if the line reads them. A live
   mask keeps its terms and is made again in the same way. A group's own heights are empty: its members are the rows
   directly below it that are deeper than it, and their composite (composite.h) replaces its heights and
   coverage. All fields of a document have one size and one wrap. */
typedef struct WrLayer {
    char *name;    /* UTF-8, owned; not necessarily unique */
    char *line;    /* command line of a generator layer; NULL: a plain layer. Owned */
    WrHash below;  /* hash of the composite that the line read; 0: it reads none */
    uint64_t made; /* wr_field_key of the heights as the line made them */
    uint64_t seen; /* identifies the layers below for which they were found up to date; 0: none */
    uint64_t
        copied; /* key of the layer that the line copies, as it was copied; 0: none, or just opened */
    char *mask_line;    /* terms of a live mask; NULL: a plain mask, or none. Owned */
    WrHash mask_read;   /* of all that the terms read */
    uint64_t mask_made; /* wr_field_key of the mask as the terms made it */
    uint64_t mask_seen; /* identifies the layers below for which it was found up to date; 0: none */
    WrField *heights;   /* owned; shared tiles */
    WrField *cover;     /* 0..1, coverage: where the layer has content; NULL: 1 everywhere. Owned */
    WrField *mask;      /* 0..1, visible share; NULL: 1 everywhere. Owned */
    WrBlend blend;      /* blend mode (blend.h) */
    float opacity;      /* 0..1 */
    float radius;       /* of the smooth blends, height units, >= 0 */
    bool visible;       /* hidden layers are not in the composite, and edits of them are refused */
    bool locked;        /* edits are refused */
    bool on_mask;       /* edits change its mask, which then exists */
    WrFilter filter;    /* op NULL: not a filter */
    int depth;          /* 0..WR_DEPTH_MAX, the number of groups that it is in */
    bool is_group;      /* then its depth is below WR_DEPTH_MAX */
    bool collapsed;     /* of a group: lists of layers omit its members */
    char *values; /* in the variants that contain the layer (variants.h); NULL: in none. Owned */
} WrLayer;

typedef struct WrComposite WrComposite; /* private to the module */

/* Commands edit the active layer's fields in place, replace `selection` and replace `scene`. */
typedef struct WrDocument {
    /* [layer_count], bottom first, owned; at least one. The top row has depth 0, every other at most that of the row above
       it, or one more if that is a group. */
    WrLayer *layers;
    int layer_count;
    int active;             /* index of the layer that edits change */
    int solo;               /* index of the layer that is shown alone, even if hidden; -1: none */
    WrField *selection;     /* 0..1, area of edits; NULL: everywhere. Owned */
    WrScene *scene;         /* shared; replaced, never modified */
    char *variants;         /* names of its variants (variants.h); NULL: none. Owned */
    char *variant;          /* name of the variant in use; NULL: none. Owned */
    WrComposite *composite; /* updated on request */
} WrDocument;

/* An empty document: a 512 x 512 table at 0, periodic, one layer "base", the default scene. */
WrDocument *wr_document_new(void);
/* A snapshot. Its cost depends only on the number of layers; later edits of either document do not affect the
   other. */
WrDocument *wr_document_share(const WrDocument *document);
/* A snapshot without the composite, so that only the document itself is kept in memory. */
WrDocument *wr_document_snapshot(const WrDocument *document);
/* Exchanges the cached composites, so that `document` updates the composite of `from` by its differences instead
   of building a new one. */
void wr_document_swap_composites(WrDocument *document, WrDocument *from);
void wr_document_free(WrDocument *document); /* NULL is fine */

/* The composited F: the visible layers blended from the bottom up (composite.h), or the solo layer alone on the
   ground (for a solo filter: the layers up to it in its group; for a group: with its members). A document of one plain layer (visible, opacity 1, no mask,
   mode equivalent to mix) returns that layer's heights themselves; otherwise tiles that changed since the last
   call are computed again. Borrowed until the next edit. Any number of threads may call it as long as nobody
   edits. */
const WrField *wr_document_field(const WrDocument *document);
/* The composited F, with a pool for the changed tiles; NULL: this thread. */
const WrField *wr_document_composite(const WrDocument *document, WrPool *pool);

/* A filter that fails for lack of memory passes its input through, and is tried again the next time.
   wr_filters_carried: true if all filters succeeded that the calling thread composited since wr_filters_forget;
   false: an error that names the layer. Cancellation is not a failure. */
void wr_filters_forget(void);
bool wr_filters_carried(WrError *err);
/* The composite; NULL and the error if a filter failed. pool: as above. */
const WrField *wr_document_whole(const WrDocument *document, WrPool *pool, WrError *err);

/* The composite of the visible layers below layer `index` (0..layer_count - 1) in its own group, as a filter there reads
   it (composite.h); 0 where there are none. A new table, owned by the caller. For a layer with a line or a live mask only
   tiles that changed since the last call are blended again. Any number of threads may call it as long as nobody edits. */
WrField *wr_document_below(const WrDocument *document, int index, WrPool *pool);

/* Hash of everything that a document file stores: layers with their names, settings and fields, the selection,
   the active and the solo layer; the scene is included by scene_text, its canonical commands. */
WrHash wr_document_hash(const WrDocument *document, const char *scene_text);

/* Bytes of memory for keeping `before` beside `after`: tiles and pictures of either that the other does not
   share, and the structs. Visits only the differences. */
size_t wr_document_difference(const WrDocument *before, const WrDocument *after);

/* ---- layers ---- */

/* A layer of the field's size and wrap: heights 0, cover 0, add, opacity 1. */
WrLayer wr_layer_make(const char *name, const WrField *like);
WrLayer wr_layer_make_filter(const char *name, const WrFilter *filter,
                             const WrField *like); /* mix, opacity 1 */
WrLayer wr_layer_share(const WrLayer *layer);      /* a copy with shared fields */
void wr_layer_fini(WrLayer *layer);
/* Makes a generator layer of it: its present heights are those of the line (copied). NULL: a plain layer. below: as in
   WrLayer */
void wr_layer_set_line(WrLayer *layer, const char *line, WrHash below);
/* Makes the layer's mask a live one: its present mask is that of the terms (copied). NULL, or no mask: a plain mask. read:
   as mask_read in WrLayer */
void wr_layer_set_mask_line(WrLayer *layer, const char *line, WrHash read);
/* Target of edits: the active layer itself; or, if they go to its mask, `stand_in`, a plain layer with the
   mask's values as heights, which shares its texels with the mask as long as they are written in place. Every
   edit_begin (a second one has no effect) needs its edit_end before anything else of the document is changed. */
typedef struct WrStandIn {
    WrLayer layer;   /* heights: the mask itself, or its replacement; NULL: none */
    WrField *before; /* the mask before the edit; owned */
    int index;       /* of the layer that the mask belongs to */
} WrStandIn;
WrLayer *wr_document_edit_begin(WrDocument *document, WrStandIn *stand_in);
/* Stores the edited mask, clamped to 0..1. No effect without edit_begin. */
void wr_document_edit_end(WrDocument *document, WrStandIn *stand_in);
bool wr_document_filters(const WrDocument *document); /* true if any layer is a filter */
bool wr_document_groups(const WrDocument *document);  /* true if any is a group */
/* true if any is a generator layer or has a live mask */
bool wr_document_generates(const WrDocument *document);
/* True if it is visible, no filter and no group, and hides all layers below it in its group in every texel: opaque, and
   without a mask. */
bool wr_layer_hides(const WrLayer *layer);
/* True if the layer is shown: it and all groups that it is in are visible, and no other layer is solo. A solo group shows its
   visible members. */
bool wr_document_shows(const WrDocument *document, int index);
/* The nearest layer of that name below layer `index`; -1: none. */
int wr_document_find_below(const WrDocument *document, int index, const char *name);
/* True if the layer and all groups that it is in are visible. */
bool wr_document_is_visible(const WrDocument *document, int index);
/* True if the layer and all groups that it is in, up to but not including group `top` (-1: all), are visible. */
bool wr_document_is_visible_up_to(const WrDocument *document, int index, int top);
/* True if the layer has heights of its own: it is neither a filter nor a group. */
bool wr_layer_holds(const WrLayer *layer);

/* ---- groups ---- */

/* The lowest row of a layer with its members: `index` itself unless it is a group with members. */
int wr_layers_first(const WrLayer *layers, int index);
/* The lowest row of the group that the layer is in, or 0. */
int wr_layers_first_sibling(const WrLayer *layers, int index);
/* The group that layer `index` is in; -1: none. */
int wr_document_parent(const WrDocument *document, int index);
/* True if layer `index` is among the members of `group`, at any depth. */
bool wr_document_is_within(const WrDocument *document, int index, int group);
/* Fails if a layer is in more than WR_DEPTH_MAX groups, or in one that does not exist, or is a group and a filter or
   generator layer. */
bool wr_document_check_groups(const WrDocument *document, WrError *err);

/* Makes a group of the chosen layers and their members, in the place of the highest of them, and returns its index.
   It is active, and has the blend and the radius of its lowest layer, so that the composite changes as little as possible; if
   that is a filter or subtracts: add; for mix: replace. Returns -1, and changes nothing, if more than
   WR_DEPTH_MAX groups would be nested. chosen: [layer_count], at least one */
int wr_document_group(WrDocument *document, const bool chosen[], const char *name);
/* Removes the group but not its members. It must not be an empty one that is the last layer. */
void wr_document_ungroup(WrDocument *document, int index);
/* Makes a plain layer of a group, which leaves every bit of the composite, and returns its index. Its hidden members are
   lost. */
int wr_document_rasterize_group(WrDocument *document, int index, WrPool *pool);

/* ---- order ---- */

/* Structural changes keep `active` and `solo` at the same layers. If one of these is removed, active moves to
   the layer below (else above), solo to none. */
/* Takes ownership of the layer. Its depth is limited to that of the row below, or 0, and to that of the row above, or one
   more if that is a group: so a layer with depth 0 joins the group of the row below. */
void wr_document_insert(WrDocument *document, int index, WrLayer layer);
/* Adds a filter above the active layer and makes it active. The selection becomes its mask. */
void wr_document_add_filter(WrDocument *document, const char *name, const WrFilter *filter);
/* removes it with its members; these must not be all layers */
void wr_document_remove(WrDocument *document, int index);
/* The least and the largest depth that layer `from`, moved with its members, could have with the index `to`. to: from the
   number of its members to layer_count - 1 */
void wr_document_move_depths(const WrDocument *document, int from, int to, int *least, int *most);
/* Moves it there with its members. depth: in that range; with the members at most WR_DEPTH_MAX */
void wr_document_move(WrDocument *document, int from, int to, int depth);
/* Number of groups nested in the layer: 0 for a layer, 1 for a group with layers ... */
int wr_document_height(const WrDocument *document, int index);
/* Replaces all layers by one layer "base" of these heights (takes ownership); clears the selection. */
void wr_document_start_over(WrDocument *document, WrField *heights);

/* Merges layer index and the one below in its group, which exists, into one layer, which keeps the lower one's name and
   position; both must be visible; groups among them become layers first. The composite is unchanged up to rounding:
     - onto the bottom layer, or that of a group: exact; the new layer has the composite of the two and mode add;
     - add or subtract onto add or subtract: the new layer has the sum of both;
     - any others: the new layer has the change that the two make to the composite of the layers below, with mode
       add, so later edits below no longer interact with the old layers' blends.
   In the last two each height changes by at most 2^-21 times the largest height involved there. If the thread's
   progress is cancelled, this and the following function leave a document that can only be freed. */
void wr_document_merge(WrDocument *document, int index, WrPool *pool);
/* Flattens to one layer with the bottom one's name that has the composite of the visible layers, bit for bit,
   ignoring solo; hidden layers are lost. The selection is kept. */
void wr_document_flatten(WrDocument *document, WrPool *pool);
