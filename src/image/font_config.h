/* font_config.h - safe initialisation of fontconfig.
   Private to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Loads its list of installed fonts, once. Without a cache fontconfig reads every font itself, which
 * needs seconds, and fonts are untrusted: so this is tried first in a copy of the process, which may
 * crash.
 *
 * Errors   it fails, or a font makes it crash or hang; "cancelled". The next call tries again
 * Threads  any */
bool wr_font_config(WrError *err);
