/* kern_wide_table.h - the text of each kern_wide_*.c, which defines WR_WIDE_TABLE. A header without a guard, by
   intention. */
#include "base/kernmath.h"

#include "render/kern_wide_body.h"
#ifdef WIDE
#include "render/kern_wide_light_body.h"

const WrWide WR_WIDE_TABLE = { .shade = wide_shade };
#else
const WrWide WR_WIDE_TABLE = { 0 };
#endif
