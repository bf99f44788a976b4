/* open_interposer.h - descriptor and path of the file that the reader process decodes.

   Used only by the reader process; not in the module's library. On Linux it replaces the open functions
   of the C library for this path, since the sandbox opens no files; on other systems it is empty.
   Belongs to one system: platform code, see src/README.md. */
#pragma once

#define WR_INTERPOSED_FILE 4 /* wr_fd_name returns its path */
