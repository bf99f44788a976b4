/* coarse_preview.h - fast preview of one changed layer: the change of the composite is computed on a smaller table, enlarged and
   added to the exact composite, so that all other layers keep their detail. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrField WrField;
typedef struct WrFilter WrFilter;
typedef struct WrPool WrPool;

/* A small copy of the layers from one layer up, above the composite of those below it; immutable. */
typedef struct WrCoarse WrCoarse;

/* Factor by which tables of this document are reduced; 1: it is small enough, or a layer is shown alone. */
int wr_coarse_step(const WrDocument *document);
/* The small copy for changes of layer `index`; is_new: of a layer that is to be inserted there. The caller owns it. */
WrCoarse *wr_coarse_new(const WrDocument *document, int index, bool is_new, WrPool *pool);
/* Any number of threads may share one. */
WrCoarse *wr_coarse_share(const WrCoarse *coarse);
void wr_coarse_free(WrCoarse *coarse); /* NULL is allowed */
/* True if it is of this document, as far as the composite goes, and of that layer. */
bool wr_coarse_fits(const WrCoarse *coarse, const WrDocument *document, int index, bool is_new,
                    WrPool *pool);

/* A small document for the change: its layer 0 has the composite of the layers below, and the layers from there up follow. The
   caller owns it. */
WrDocument *wr_coarse_begin(const WrCoarse *coarse);
int wr_coarse_layer(const WrCoarse *coarse);  /* index of the changed layer in it */
int wr_coarse_factor(const WrCoarse *coarse); /* the factor of its size */
/* A field, reduced to the small size by its nearest texels. The caller owns it. */
WrField *wr_coarse_reduce(const WrCoarse *coarse, const WrField *field, WrPool *pool);
/* The filter with lengths in texels of the small size. */
WrFilter wr_coarse_filter(const WrCoarse *coarse, const WrFilter *filter);
/* The composite of the document with the change of the small one. The caller owns it. */
WrField *wr_coarse_end(const WrCoarse *coarse, const WrDocument *changed, WrPool *pool);
