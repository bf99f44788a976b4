/* composite.h - the sum of several layers, kept up to date tile by tile.
   Layer 5. Private to this room. */
#pragma once
#include "document/document.h"

/* Empty; costs nothing until updated. The caller owns it. */
WrComposite *wr_composite_new(void);
/* A second one that knows what the first knows, in constant time a layer, for a snapshot. */
WrComposite *wr_composite_share(const WrComposite *composite);
void wr_composite_free(WrComposite *composite); /* NULL is fine */

/* F = the layers' sum, texel by texel: added in double from the bottom up and rounded once, so that no
 * order of edits shows. All layers have one size. Only tiles that changed since the last call are
 * added again. Any number of threads may ask at once, as long as nobody edits the layers.
 * Borrowed: valid until the next call after an edit. */
const WrField *wr_composite_update(WrComposite *composite, const WrLayer *layers, int count);
