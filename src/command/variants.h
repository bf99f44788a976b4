/* variants.h - variants of a document: named sets of layers' values, so that one document holds several versions.

   A variant has the visibility, blend, opacity and radius of each layer, the line of a generator layer, the terms of a live
   mask and the values of a filter; no heights and no scene. A layer that was added after the variant was stored is hidden in
   it. Names: document/variants.h. */
#pragma once
#include "document/variants.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrSession WrSession;

/* True if the document's values differ from those of the variant in use; false if none is in use. */
bool wr_variant_differs(const WrDocument *document);

/* ---- files for each variant ---- */

#define WR_VARIANT_PATTERN "<VARIANT>"

/* True if the name of a file stands for one file for each variant. */
bool wr_variant_is_pattern(const char *path);
/* The name with the variant's in place of <VARIANT>; in it / and a leading . become -. variant NULL: a copy. The caller
   frees it. */
char *wr_variant_fill(const char *pattern, const char *variant);
/* "a/b.png" -> "a/b_<VARIANT>.png"; of a name with <VARIANT> a copy. The caller frees it. */
char *wr_variant_insert(const char *path);
/* If `path` is a pattern, use each variant in turn and call `work` with its name; the document is unchanged afterwards.
   Else call it once, with NULL. Error: that of the work or of a variant; no variants; two with the same file name. */
typedef bool WrVariantWork(void *ctx, const char *variant, WrError *err);
bool wr_session_for_variants(WrSession *session, const char *path, WrVariantWork *work, void *ctx,
                             WrError *err);
