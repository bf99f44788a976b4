#include "ui/toolkit/theme.h"

static const WrColour colours[][WR_THEME_KINDS] = {
#define WR_THEME_ROW(name, dark, light, contrast) { dark, light, contrast },
    WR_THEME_COLOURS(WR_THEME_ROW)
#undef WR_THEME_ROW
};

static WrThemeKind shown;

WrThemeKind wr_theme(void)
{
    return shown;
}

void wr_theme_set(WrThemeKind kind)
{
    shown = kind;
}

WrColour wr_theme_colour(WrThemeColour name)
{
    return colours[name][shown];
}

const WrColour wr_series[WR_SERIES] = { 0xff3a7bd5u, 0xffda9c58u, 0xff288462u, 0xffc9a8ecu,
                                        0xffc6452au, 0xfff0e08cu, 0xff7d849du };
