/* sandbox_open.h - the one file of a reading: its descriptor, and the path by which libraries know it.
   Part of the reader process alone: it is not in the room's library. On Linux it answers for that path by itself, since
   the cage opens nothing; elsewhere it has nothing in it.
   Belongs to one system: platform code, see src/README.md. */
#pragma once

#define WR_SANDBOX_OPEN_FILE 4 /* wr_fd_name tells the path */
