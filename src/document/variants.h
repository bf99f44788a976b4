/* variants.h - names of a document's variants: sets of layers' values, such as "worn" and "new".

   The values are text that each layer keeps (WrLayer.values), one line for each variant that contains it, beginning with the
   variant's name. They stay with their layer when it is moved, renamed or duplicated. command/variants.h makes and reads
   them. */
#pragma once
#include <stdbool.h>

typedef struct WrDocument WrDocument;

#define WR_VARIANTS_MAX 64
#define WR_VARIANT_NAME_MAX 255 /* maximum bytes of a name: no control characters */

int wr_variant_count(const WrDocument *document);
/* Copies name i (0 <= i < count) to `name`. */
void wr_variant_name(const WrDocument *document, int i, char name[WR_VARIANT_NAME_MAX + 1]);
/* Index of that name; -1: none. */
int wr_variant_find(const WrDocument *document, const char *name);

/* Replaces the list and the name of the variant in use (NULL: none) by texts of a file: names that are not allowed,
   duplicates and those beyond the maximum are left out. names: one a line; NULL: none, and the layers keep no values. */
void wr_document_set_variants(WrDocument *document, const char *names, const char *in_use);
/* Replaces name i, or removes it (NULL), or appends one (i == count). The layers' values stay as they are. */
void wr_variant_put_name(WrDocument *document, int i, const char *name);
