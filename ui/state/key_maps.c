/* Built-in key maps, in the format of a user's key file. */
#include "ui/state/keys.h"

#include "base/enum_rows.h"

WR_ROWS(wr_key_maps);
const WrKeyMapText wr_key_maps[WR_KEY_MAPS] = {
    [WR_ROW(WR_KEYS_PAINT)] = { .label = "Paint",
                                .help = "Ctrl picks a height, Shift and dragging sizes the brush; "
                                        "Alt turns it round",
                                .text = "" },
    [WR_ROW(WR_KEYS_SCULPT)] = { .label = "Sculpt",
                                 .help = "Ctrl turns raise and lower round, Shift smooths; Alt "
                                         "picks a height",
                                 .text = "hold_invert: Ctrl\n"
                                         "hold_smooth: Shift\n"
                                         "hold_pick: Alt\n"
                                         "hold_size: Alt+Shift\n" },
};
WR_ROWS_END(wr_key_maps, WR_KEY_MAPS);
