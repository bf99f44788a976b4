/* edit_preview_generate.h - what a command line, most often a generator's, would make of a document. */
#pragma once
#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrText WrText;

/* Join what the line makes to the document's active layer, inside its selection, as the command would.
 *
 * document  changed; half done after a failure
 * line      of one of the generators' families; files as the current folder sees them
 * rough     as fast as may be: worse where that helps, on a smaller table where nothing but its size
 *           tells
 * notes     what there is to say besides, one a line
 * Threads   one for each document */
bool wr_edit_preview_generate(WrDocument *document, const char *line, bool rough, WrPool *pool,
                              const WrProgress *progress, WrText *notes, WrError *err);

/* The same of a `transform` line. */
bool wr_edit_preview_transform(WrDocument *document, const char *line, WrPool *pool,
                               const WrProgress *progress, WrError *err);
