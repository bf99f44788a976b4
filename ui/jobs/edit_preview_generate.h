/* edit_preview_generate.h - application of a generator or transform line to a document, for previews. */
#pragma once
#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrText WrText;

/* Blend the output of a generator line into the document's active layer, inside its selection, as the command would.
 *
 * document  changed; half done after a failure
 * line      of a generator family; relative file names refer to the current folder
 * rough     fastest mode: lower quality, and a smaller table if the result depends only on the relative size
 * notes     remarks, one per line
 * Threads   one for each document */
bool wr_edit_preview_generate(WrDocument *document, const char *line, bool rough, WrPool *pool,
                              const WrProgress *progress, WrText *notes, WrError *err);

/* Apply a `transform` line to the document. */
bool wr_edit_preview_transform(WrDocument *document, const char *line, WrPool *pool,
                               const WrProgress *progress, WrError *err);
