#include "ui/toolkit/theme.h"
#include "ui/toolkit/gui.h"

#include <string.h>

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

/* ---- words for missing icons ---- */

static const struct {
    const char *icon, *word;
} words[] = {
    { WR_ICON_BRUSH, "Br" },     { WR_ICON_HAND, "Pan" },    { WR_ICON_ZOOM, "Zm" },
    { WR_ICON_PICK, "Pk" },      { WR_ICON_PLAY, ">" },      { WR_ICON_PAUSE, "||" },
    { WR_ICON_DOWN, "v" },       { WR_ICON_CLOSE, "x" },     { WR_ICON_PLUS, "+" },
    { WR_ICON_DELETE, "Del" },   { WR_ICON_HELP, "?" },      { WR_ICON_ALERT, "!" },
    { WR_ICON_FOLDER, "/" },     { WR_ICON_FILE, "-" },      { WR_ICON_UP, "^" },
    { WR_ICON_CHECK, "ok" },     { WR_ICON_CAMERA, "3D" },   { WR_ICON_EYE, "on" },
    { WR_ICON_EYE_OFF, "off" },  { WR_ICON_LOCK, "L" },      { WR_ICON_UNLOCK, "un" },
    { WR_ICON_COPY, "Cp" },      { WR_ICON_MERGE, "Mg" },    { WR_ICON_LOWER, "dn" },
    { WR_ICON_RECT, "[ ]" },     { WR_ICON_ELLIPSE, "( )" }, { WR_ICON_LASSO, "Ls" },
    { WR_ICON_MORE, ":" },       { WR_ICON_STAR, "*" },      { WR_ICON_STAR_OFF, "-*" },
    { WR_ICON_DROP, "Sm" },      { WR_ICON_FINGER, "Sr" },   { WR_ICON_CLONE, "Cl" },
    { WR_ICON_BOX, "Rc" },       { WR_ICON_ROUND, "El" },    { WR_ICON_POLYGON, "Pg" },
    { WR_ICON_CURVE, "Cv" },     { WR_ICON_BUCKET, "Fi" },   { WR_ICON_RAMP, "Ra" },
    { WR_ICON_STAMP, "St" },     { WR_ICON_MIRROR, "|" },    { WR_ICON_TUNE, "Tu" },
    { WR_ICON_SAVE, "Sv" },      { WR_ICON_BACK, "Bk" },     { WR_ICON_DOTS, "..." },
    { WR_ICON_WAND, "Wd" },      { WR_ICON_DICE, "Rnd" },    { WR_ICON_GRID, "Gr" },
    { WR_ICON_TRANSFORM, "Tf" }, { WR_ICON_ERASER, "Er" },   { WR_ICON_TEXT, "T" },
    { WR_ICON_CUBE, "So" },      { WR_ICON_OPENED, "v" },    { WR_ICON_CLOSED, ">" },
    { WR_ICON_LINK, "Li" },
};

const char *wr_icon_word(const char *icon)
{
    for (size_t i = 0; icon && i < sizeof words / sizeof *words; i++)
        if (strcmp(words[i].icon, icon) == 0) return words[i].word;
    return icon;
}
