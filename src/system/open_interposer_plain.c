/* No replacement here: a system whose sandbox forbids opening paths has to replace the open functions
   for the file being read, as Linux does. */
#include "system/open_interposer.h"

_Static_assert(WR_INTERPOSED_FILE > 2, "beside the standard files");
