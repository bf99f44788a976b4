/* live_masks.h - terms of a live mask: the text that a layer keeps, as calls (command_line.h) and back. */
#pragma once
#include <stdbool.h>

typedef struct WrCall WrCall;
typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_MASK_TERMS 16 /* maximum terms of a mask */

typedef struct WrMaskTerms {
    int count;
    WrCall *calls[WR_MASK_TERMS]; /* owned; their forms are the kinds */
} WrMaskTerms;

const char *wr_mask_kind(int i); /* name of a kind of term; NULL past the last */
/* On success wr_mask_terms_free frees them. */
bool wr_mask_terms_parse(const char *line, WrMaskTerms *terms, WrError *err);
void wr_mask_terms_print(const WrMaskTerms *terms, WrText *line);
void wr_mask_terms_free(WrMaskTerms *terms);
/* Index of the layer that a term of the mask of layer `index` names; -1: none, or it is not below. */
int wr_mask_term_layer(const WrDocument *document, int index, const WrCall *term);
/* Indices of all layers that the live mask of layer `index` names; returns their number. */
int wr_mask_named(const WrDocument *document, int index, int named[WR_MASK_TERMS]);
