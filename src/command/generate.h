/* generate.h - what a command line of one of the generators' families describes: `pattern bricks across=6`.
   Layer 6. */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrGenerator WrGenerator;
typedef struct WrLayer WrLayer;
typedef struct WrParamValue WrParamValue;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrNormalMips WrNormalMips;

/* The generator that the line names, or NULL if its verb is no family. */
const WrGenerator *wr_call_generator(const WrCall *call);

/* The values of its parameters, given or default. values: [WR_GENERATOR_PARAMS], borrowed from the call;
 * texts and file names as they are written. */
void wr_call_values(const WrCall *call, const WrGenerator *generator, WrParamValue *values);

/* The name of the argument that all generators have besides their parameters, which is `plain` ("blend",
 * "radius", "offset") unless the generator has a parameter of that name: then "blend-radius" and so on. */
const char *wr_generator_argument(const WrGenerator *generator, const char *plain);

/* A text as a line has it, with \n for a new line and \\ for a backslash (any other stands for itself), as the
 * generator takes it. Caller frees. */
char *wr_generator_text(const char *text);

/* What the line's generator made joins a layer, as the line's other arguments say, within `selection` (NULL:
 * everywhere). False: cancelled, and the layer is half done. */
bool wr_call_join(const WrCall *call, const WrNormalMips *relief, const WrField *selection,
                  WrLayer *layer, WrPool *pool, const WrProgress *progress, WrError *err);
