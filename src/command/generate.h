/* generate.h - what a command line of one of the generators' families describes: `pattern bricks across=6`.
   Layer 6. */
#pragma once
#include "command/call.h"

/* The generator that the line names, or NULL if its verb is no family. */
const WrGenerator *wr_call_generator(const WrCall *call);

/* The values of its parameters, given or default. values: [WR_GENERATOR_PARAMS], borrowed from the call;
 * texts and file names as they are written. */
void wr_call_values(const WrCall *call, const WrGenerator *generator, WrParamValue *values);

/* The name of the argument that all generators have besides their parameters, which is `plain` ("blend",
 * "radius", "offset") unless the generator has a parameter of that name: then "blend-radius" and so on. */
const char *wr_generator_argument(const WrGenerator *generator, const char *plain);
