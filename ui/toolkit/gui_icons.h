/* gui_icons.h - what stands in the place of icons where their font is missing. */
#pragma once

/* One to three plain letters for a WR_ICON_...; any other text is given back. */
const char *wr_icon_word(const char *icon);
