/* made_from.h - the tables from which live masks and layers were made, so that they are made again only near the changes of
   these. Shares: a table that has not changed since costs nothing. */
#pragma once
#include "field/changed_blocks.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrMadeFrom WrMadeFrom;

#define WR_INPUTS_MAX 16 /* of one mask or layer */

/* Inputs in a fixed order; NULL: none, such as the coverage of a layer that is everywhere. */
typedef struct WrInputs {
    const WrField *of[WR_INPUTS_MAX];
    int count;
    WrHash values; /* of all else that the result depends on */
} WrInputs;

/* Stores the inputs of a mask or of heights. made: wr_field_key of the result. *all NULL: created */
void wr_made_from_note(WrMadeFrom **all, uint64_t made, const WrInputs *inputs);
/* Its inputs at the last making, if they have the same sizes and levels as now, and the same other values; else NULL. Borrowed
 * until the next call that changes *all. */
const WrInputs *wr_made_from_find(const WrMadeFrom *all, uint64_t made, const WrInputs *now);
/* The blocks where a result that depends on inputs within `reach` texels may differ from the one with key `made`. False: that
 * is not known, or it is most of the table. blocks: output, [*count]; the caller frees it */
bool wr_made_from_changes(const WrMadeFrom *all, uint64_t made, const WrInputs *now, int reach,
                          WrFieldRect **blocks, int *count);
/* Removes the inputs that no layer of the document needs: of hidden layers, and of replaced results. needed:
 * [layer_count] */
void wr_made_from_prune(WrMadeFrom *all, const WrDocument *document, const bool *needed);
void wr_made_from_free(WrMadeFrom *all); /* NULL is allowed */
