/* object_tables.h - height tables of a scene's objects: the composite, or one layer named by an object. Shared
   and immutable, so that renders on other threads can hold them. */
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
        [WR_OBJECTS_MAX]; /* own shares; NULL: the composite. In the form of WrFrameRequest.fields */
} WrTables;

/* Cached composites of single layers with masks etc., updated instead of built anew. Zero-initialise; fini
   frees. */
typedef struct WrTableCache {
    WrDocument *alone[WR_OBJECTS_MAX]; /* the document with that object's layer as solo */
} WrTableCache;

/* The tables of the scene's objects. The caller owns them; NULL: all objects use the composite. An object whose
   layer no longer exists uses it too. cache may be NULL. */
WrTables *wr_document_tables(const WrDocument *document, const WrScene *scene, WrTableCache *cache,
                             WrPool *pool);
/* wr_document_layer_alone: heights of layer `index` alone; the caller owns it. wr_layer_key: a number that
   changes when these may have changed. */
WrField *wr_document_layer_alone(const WrDocument *document, int index, WrPool *pool);
uint64_t wr_layer_key(const WrDocument *document, int index);
/* The topmost layer of that name; -1: there is none, or the name is NULL. */
int wr_layer_named(const WrDocument *document, const char *name);
/* The mesh of the active object in whose (u,v) the active layer lies, and the layer's repetition there: a mask lies once in
 * the file's own (u,v). Borrowed; NULL: no mesh. */
const WrTriangles *wr_document_painted_mesh(const WrDocument *document, double *ru, double *rv);
WrTables *wr_tables_share(const WrTables *tables); /* NULL stays NULL */
void wr_tables_free(WrTables *tables);             /* NULL is fine */
bool wr_tables_same(const WrTables *a, const WrTables *b);
/* The table of the current object; `all`: the composite, used if it has no other. Borrowed from either. */
const WrField *wr_tables_at_hand(const WrTables *tables, const WrScene *scene, const WrField *all);
/* The array for WrFrameRequest.fields; NULL without tables. */
const WrField *const *wr_tables_fields(const WrTables *tables);
void wr_table_cache_fini(WrTableCache *cache);
