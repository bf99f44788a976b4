/* document.h - what a user works on: layers of heights, a selection and a scene. Plain data.
   Layer 5. Only a session (command/session.h) changes a document. */
#pragma once
#include "base/hash.h"
#include "document/blend.h"
#include "field/ops.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

#define WR_LAYERS_MAX 256     /* of a document */
#define WR_LAYER_NAME_MAX 255 /* bytes of a layer's name */

/* One layer. A filter's heights are empty: what joins the layers below it is what the operation makes of
   their composite, which is kept up to date. All fields of a document have one size and one wrap. */
typedef struct WrLayer {
    char *name;       /* UTF-8, owned; names need not differ */
    WrField *heights; /* owned; shared tiles */
    WrField *cover;   /* 0..1, where the layer says something; NULL: everywhere. Owned */
    WrField *mask;    /* 0..1, how much of it shows; NULL: all. Owned */
    WrBlend blend;    /* how it joins what lies below (blend.h) */
    float opacity;    /* 0..1 */
    float radius;     /* of the smooth blends, height units, 0 or more */
    bool visible;     /* hidden layers are not in the composite, and edits refuse them */
    bool locked;      /* edits refuse it */
    bool on_mask;     /* edits go to its mask, which it then has */
    WrFilter filter;  /* op NULL: it is none */
} WrLayer;

typedef struct WrComposite WrComposite; /* private to the room */

/* Commands edit the active layer's fields in place, replace `selection` and replace `scene`. */
typedef struct WrDocument {
    WrLayer *layers; /* [layer_count], bottom first, owned; at least one */
    int layer_count;
    int active;             /* index of the layer that edits change */
    int solo;               /* index of the layer that is shown alone, hidden or not; -1: none */
    WrField *selection;     /* 0..1, where edits act; NULL: everywhere. Owned */
    WrScene *scene;         /* shared; replaced, never written */
    WrComposite *composite; /* kept up to date when asked for */
} WrDocument;

/* An empty document: a 512 x 512 table at 0, periodic, one layer "base", the default scene. */
WrDocument *wr_document_new(void);
/* A snapshot: cost goes by the layers' number alone; later edits of either do not show in the other. */
WrDocument *wr_document_share(const WrDocument *document);
/* The same without the composite, so that nothing but the document itself is kept alive. */
WrDocument *wr_document_snapshot(const WrDocument *document);
/* Let `document` have what `from` knows of its composite, which is then brought up to date by what
   differs instead of being made anew; `from` gets the other's. */
void wr_document_swap_composites(WrDocument *document, WrDocument *from);
void wr_document_free(WrDocument *document); /* NULL is fine */

/* The composited F: the visible layers joined from the bottom up (compositor.h), or the solo layer alone
 * on the ground (a filter alone: the layers up to it). A document of one plain layer (visible, opacity 1,
 * no mask, taken as it is) has that layer's heights themselves; otherwise tiles that changed since the
 * last call are done again. Borrowed until the next edit. Any number of threads may call it as long as
 * nobody edits. */
const WrField *wr_document_field(const WrDocument *document);
/* The same, with a pool for the tiles that changed; NULL: this thread. */
const WrField *wr_document_composite(const WrDocument *document, WrPool *pool);

/* A filter that cannot be carried out, for want of memory, leaves what it was given in its place, and is tried again the
 * next time. wr_filters_carried: were all carried out that the calling thread composited since it last forgot? false: an
 * error that names the layer. What was cancelled does not count. */
void wr_filters_forget(void);
bool wr_filters_carried(WrError *err);
/* The composite, with all filters carried out; NULL where one was not, which is the error. pool: as above. */
const WrField *wr_document_whole(const WrDocument *document, WrPool *pool, WrError *err);

/* What lies below layer `index` (0..layer_count - 1): the composite of the visible layers under it, 0 where
 * there is nothing. A table of its own, the caller's. */
WrField *wr_document_below(const WrDocument *document, int index, WrPool *pool);

/* All that a document file keeps: layers with their names, settings and fields, the selection, which
   layer is active and alone; the scene enters through scene_text, its canonical commands. */
WrHash wr_document_hash(const WrDocument *document, const char *scene_text);

/* Bytes of memory that it costs to keep `before` beside `after`: tiles and pictures of either that the
 * other does not share, and the structs. Looks only at what differs. */
size_t wr_document_difference(const WrDocument *before, const WrDocument *after);

/* ---- layers ---- */

/* A layer of the field's size and wrap, heights 0, saying nothing anywhere (cover 0), add, opacity 1. */
WrLayer wr_layer_new(const char *name, const WrField *like);
WrLayer wr_layer_of_filter(const char *name, const WrFilter *filter,
                           const WrField *like); /* mix, opacity 1 */
WrLayer wr_layer_share(const WrLayer *layer);    /* a second one, fields shared */
void wr_layer_fini(WrLayer *layer);
/* What edits are to change: the active layer itself; or, where they go to its mask, `stand_in`, a plain layer of the
 * mask's values as heights, which shares its texels with the mask as long as they are written in place. Every
 * beginning (a second one changes nothing) needs its end before anything else of the document is touched. */
typedef struct WrStandIn {
    WrLayer layer;   /* heights: the mask itself, or what came in its place; NULL: none */
    WrField *before; /* the mask as it was; owned */
    int index;       /* of the layer whose mask it is */
} WrStandIn;
WrLayer *wr_document_edit_begin(WrDocument *document, WrStandIn *stand_in);
/* The mask is what was made of it, kept to 0..1. Does nothing without a beginning. */
void wr_document_edit_end(WrDocument *document, WrStandIn *stand_in);
bool wr_document_filters(const WrDocument *document); /* is any of its layers a filter? */
/* Is it shown: visible, and no other layer alone? */
bool wr_document_shows(const WrDocument *document, int index);

/* Structural changes keep `active` and `solo` at the layers that they meant; where one of these goes away,
   active falls to the layer below (else above), solo to none. */
void wr_document_insert(WrDocument *document, int index, WrLayer layer); /* takes it */
/* A filter above the active layer, which becomes active. What is selected is its mask. */
void wr_document_add_filter(WrDocument *document, const char *name, const WrFilter *filter);
void wr_document_remove(WrDocument *document, int index); /* not the last one */
void wr_document_move(WrDocument *document, int from, int to);
/* One layer "base" of these heights (taken) in the place of all; no selection. */
void wr_document_start_over(WrDocument *document, WrField *heights);

/* Join layer index (1 or more) and the one below to one layer, which keeps the lower one's name and place;
 * both must be visible. The composite stays, up to rounding:
 *   - onto the bottom layer: exactly; the new layer holds the composite of the two and is added;
 *   - add or subtract onto add or subtract: the new layer holds the sum of what they add;
 *   - any others: the new layer holds what the two change in the composite of the layers below, and adds
 *     that, so later edits below no longer meet the old layers' blends.
 * In the last two each height changes by at most 2^-21 times the largest height that meets there.
 * Where the thread's progress is cancelled, this and what follows leave a document that is only good to be
 * thrown away. */
void wr_document_merge(WrDocument *document, int index, WrPool *pool);
/* One layer with the bottom one's name that holds the composite of the visible layers, bit for bit, solo or
   not; hidden layers are lost. The selection stays. */
void wr_document_flatten(WrDocument *document, WrPool *pool);
