/* reader_process.h - management of the reader process: started on first use, restarted after a crash,
   and kept for the next file.
   Private to this module. */
#pragma once
#include "image/reader_protocol.h"

#include <stdbool.h>

/* Starts the process if there is none; returns at once, while it still loads. Any thread. */
bool wr_process_start(WrError *err);

/* Sends it an order with the file and one end of a channel, both borrowed for the call. Any thread. */
bool wr_process_order(const WrWireOrder *order, int file, int channel, WrError *err);
