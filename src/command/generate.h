/* generate.h - the generator call in a command line such as `pattern bricks across=6`. */
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
typedef struct WrRelief WrRelief;

/* The generator that the line names, or NULL if its verb is not a generator family. */
const WrGenerator *wr_call_generator(const WrCall *call);

/* Parameter values of the line, given or default. values: [WR_GENERATOR_PARAMS], borrowed from the call; texts and
 * file names are unresolved. */
void wr_call_values(const WrCall *call, const WrGenerator *generator, WrParamValue *values);

/* Name of an argument common to all generators ("blend", "radius", "offset"). If the generator has a parameter of the
 * same name, a prefix makes it unique: "blend-radius". */
const char *wr_generator_argument(const WrGenerator *generator, const char *plain);

/* Decode the escapes of a text argument: \n is a new line, \\ a backslash; a backslash before any other character is
 * literal. The caller frees the result. */
char *wr_generator_text(const char *text);

/* Blend the output of the line's generator into a layer, by the line's other arguments, within `selection` (NULL:
 * everywhere). False: cancelled, and the layer is half done. */
bool wr_call_join(const WrCall *call, const WrRelief *relief, const WrField *selection,
                  WrLayer *layer, WrPool *pool, const WrProgress *progress, WrError *err);
