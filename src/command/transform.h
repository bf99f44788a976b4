/* transform.h - what a `transform` line does to a document, for the command and for trials of it.
   Layer 6. */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrLayer WrLayer;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

/* active: the layer that is changed, or what stands in for its mask; NULL: all layers. False: cancelled or refused, and
   the document is half done. */
bool wr_call_transform(const WrCall *call, WrDocument *document, WrLayer *active, WrPool *pool,
                       const WrProgress *progress, WrError *err);
