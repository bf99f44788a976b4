/* font_config.h - fontconfig, made ready for use.
   Private to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Load its list of installed fonts, once. Where it kept none from before it looks into every font itself, which takes
 * seconds, and fonts are strangers': so that is tried in a copy of the process first, which may crash.
 *
 * Errors   it does not work, or a font makes it crash or never end; "cancelled". The next call tries again
 * Threads  any */
bool wr_font_config(WrError *err);
