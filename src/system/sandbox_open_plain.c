/* Nothing stands before the C library here: a system whose cage lets no path be opened has to answer for the one of the
   file that is being read, as Linux does. */
#include "system/sandbox_open.h"

_Static_assert(WR_SANDBOX_OPEN_FILE > 2, "beside the standard files");
