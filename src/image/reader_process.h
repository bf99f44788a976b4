/* reader_process.h - the reader process as the program keeps it: started when first needed, started again when
   it was killed, and kept waiting for the next file.
   Private to this module. */
#pragma once
#include "image/reader_protocol.h"

#include <stdbool.h>

/* Start the process if there is none; returns at once, while it still loads. Any thread. */
bool wr_process_start(WrError *err);

/* Have it read a file: hands over the order, the file and one end of a channel, all borrowed for the
 * call. Any thread. */
bool wr_process_order(const WrWireOrder *order, int file, int channel, WrError *err);
