/* reader_child.h - a child of the reader process: reads one file for the program.
   Private to this module. Part of the reader process alone. */
#pragma once
#include "image/reader_protocol.h"

/* Answer on the channel until the program closes it. Gives up every right first (cage.h). */
void wr_serve(const WrWireOrder *order, int file, int channel);
