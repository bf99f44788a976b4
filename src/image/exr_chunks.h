/* exr_chunks.h - whether an OpenEXR file of several parts, or of tiles, just written in their order, is whole.
   Private to this module.

   The library writes the tables of where its chunks lie when it closes a file, and is silent if it cannot;
   readers then put up with zeros there, some by searching the file, others not at all. Here every entry
   must be the place where the chunk before it ended, and the last chunk must end the file. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Files of one part in rows are not looked at: their failures are told. Errors do not name the file. */
bool wr_exr_check_chunks(int fd, WrError *err);
