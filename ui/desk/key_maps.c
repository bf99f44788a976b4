/* The key maps that are shipped, as the text that a file of one's own would have. */
#include "ui/desk/keys.h"

#include "base/rows.h"

const WrKeyMapText wr_key_maps[WR_KEY_MAPS] = {
    { "Paint", "Ctrl picks a height, Shift and dragging sizes the brush; Alt turns it round", "" },
    { "Sculpt", "Ctrl turns raise and lower round, Shift smooths; Alt picks a height",
      "hold_invert: Ctrl\n"
      "hold_smooth: Shift\n"
      "hold_pick: Alt\n"
      "hold_size: Alt+Shift\n" },
};
