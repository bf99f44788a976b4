/* transform.h - application of a `transform` line to a document, for the command and for previews of it. */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrLayer WrLayer;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

/* active: the layer to change, or the stand-in for its mask; NULL: all layers. False: cancelled or refused, and the
   document is half done. */
bool wr_call_transform(const WrCall *call, WrDocument *document, WrLayer *active, WrPool *pool,
                       const WrProgress *progress, WrError *err);
