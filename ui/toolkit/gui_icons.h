/* gui_icons.h - short words in place of icons if the icon font is missing. */
#pragma once

/* One to three plain letters for a WR_ICON_...; any other text is returned unchanged. */
const char *wr_icon_word(const char *icon);
