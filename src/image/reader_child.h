/* reader_child.h - a child of the reader process: reads one file for the program.
   Private to this module.
   Only in the reader process. */
#pragma once
#include "image/reader_protocol.h"

/* Serves requests on the channel until the program closes it. Enters the sandbox first
 * (system/sandbox.h). */
void wr_serve(const WrWireOrder *order, int file, int channel);
