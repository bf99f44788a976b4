/* object_tables.h - the tables of a scene's objects: of all layers, or of one that an object names.
   Layer 5. Shared and never changed, so that a picture of another thread can hold them. */
#pragma once
#include "scene/objects.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrLayer WrLayer;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

typedef struct WrTables {
    int refs; /* atomic; private */
    int count;
    const WrField *fields
        [WR_OBJECTS_MAX]; /* own shares; NULL: of all layers. As WrFrameRequest.fields wants them */
} WrTables;

/* What was joined of layers with masks and the like, to be brought up to date rather than made anew. Zero-initialise;
   fini frees. */
typedef struct WrTableCache {
    WrDocument *alone[WR_OBJECTS_MAX]; /* the document with that object's layer shown alone */
} WrTableCache;

/* The tables of the scene's objects. The caller owns them; NULL: all objects have that of all layers. An object whose
   layer is gone has that too. cache may be NULL. */
WrTables *wr_document_tables(const WrDocument *document, const WrScene *scene, WrTableCache *cache,
                             WrPool *pool);
/* What layer `index` alone is; the caller owns it. And a number that tells whether that may be another by now. */
WrField *wr_document_layer_alone(const WrDocument *document, int index, WrPool *pool);
uint64_t wr_layer_key(const WrDocument *document, int index);
/* The uppermost layer of that name; -1: there is none, as of NULL. */
int wr_layer_named(const WrDocument *document, const char *name);
WrTables *wr_tables_share(const WrTables *tables); /* NULL stays NULL */
void wr_tables_free(WrTables *tables);             /* NULL is fine */
bool wr_tables_same(const WrTables *a, const WrTables *b);
/* Of the object at hand; `all`: where it has that of all layers. Borrowed from either. */
const WrField *wr_tables_at_hand(const WrTables *tables, const WrScene *scene, const WrField *all);
/* For WrFrameRequest.fields; NULL where there are none. */
const WrField *const *wr_tables_fields(const WrTables *tables);
void wr_table_cache_fini(WrTableCache *cache);
