/* reopen.h - the one file of a reading: its descriptor, and the path by which libraries know it.
   Private to this room. Part of the reader process alone. */
#pragma once
#include <stdbool.h>

#define WR_REOPEN_FILE 4
#define WR_REOPEN_PATH "/proc/self/fd/4"
