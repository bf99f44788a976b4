/* theme.h - colours (0xAARRGGBB, sRGB) and sizes (pixels at scale 1) of the window, in three themes. The
   surroundings are neutral grey for correct perception of greys, with one accent colour. Raise is always warm and
   lower is cool. */
#pragma once
#include <stdint.h>

typedef uint32_t WrColour; /* 0xAARRGGBB */

/* X(name, dark, light, high contrast) */
#define WR_THEME_COLOURS(X)                                                                        \
    X(SURROUND, 0xff323232u, 0xff909090u, 0xff1a1a1au) /* behind the table and the patch */        \
    X(BAR, 0xff262626u, 0xffe4e4e4u, 0xff000000u)      /* menu, option row, status line */         \
    X(PANEL, 0xff2c2c2cu, 0xffeeeeeeu, 0xff000000u)                                                \
    X(FIELD, 0xff1f1f1fu, 0xffffffffu, 0xff000000u)                                                \
    X(FIELD_HOT, 0xff252525u, 0xfff4f8fcu, 0xff282828u) /* field under the pointer */              \
    X(EDGE, 0xff3a3a3au, 0xffbababau, 0xffa0a0a0u)                                                 \
    X(TEXT, 0xffd6d6d6u, 0xff1e1e1eu, 0xffffffffu)                                                 \
    X(LABEL, 0xffa8a8a8u, 0xff505050u, 0xfff0f0f0u)                                                \
    X(STRONG, 0xfff0f0f0u, 0xff000000u, 0xffffffffu)                                               \
    X(MUTED, 0xff8a8a8au, 0xff686868u, 0xffd8d8d8u) /* secondary text */                           \
    X(FAINT, 0xff787878u, 0xff868686u, 0xffb8b8b8u) /* disabled text */                            \
    X(OFF, 0xff5c5c5cu, 0xffacacacu, 0xff8a8a8au)   /* icons of states that are off */             \
    X(ACCENT, 0xff4a8fdcu, 0xff1f6fc4u, 0xffffd400u)                                               \
    X(SELECTED, 0xff3f6fa8u, 0xffa5cbf2u, 0xff0050c8u)                                             \
    X(FILL, 0xff3a6290u, 0xffb5d3f3u,                                                              \
      0xff003c96u) /* filled part of a slider's field, below its value */                          \
    X(FILL_HOT, 0xff42709fu, 0xffa0c6eeu, 0xff0050c8u)                                             \
    X(ROW_HOT, 0xff323232u, 0xffdfe6eeu, 0xff303030u)                                              \
    X(ROW_SELECTED, 0xff36475cu, 0xffc0dbf6u, 0xff0050c8u)                                         \
    X(ROW_CHOSEN, 0xff2f3a47u, 0xffdcebf9u, 0xff002c70u) /* beside the selected row */             \
    X(LIST, 0xff292929u, 0xfff6f6f6u, 0xff000000u)                                                 \
    X(POPUP, 0xff242424u, 0xfffafafau, 0xff000000u)                                                \
    X(BUTTON, 0xff393939u, 0xffd6d6d6u, 0xff303030u)                                               \
    X(BUTTON_HOT, 0xff454545u, 0xffc6c6c6u, 0xff505050u)                                           \
    X(GRAB, 0xff444444u, 0xffbcbcbcu, 0xff909090u) /* handle of a scroll bar */                    \
    X(GRAB_HOT, 0xff555555u, 0xffa6a6a6u, 0xffc0c0c0u)                                             \
    X(GRAB_HELD, 0xff666666u, 0xff8e8e8eu, 0xffffffffu)                                            \
    X(GRID, 0xff333333u, 0xffd2d2d2u, 0xff505050u) /* lines of plots */                            \
    X(RAISE, 0xffc7772eu, 0xffb4560au, 0xffff9a3cu)                                                \
    X(LOWER, 0xff2e86b8u, 0xff17739fu, 0xff4cc2ffu)                                                \
    X(LEVEL, 0xff6f7a86u, 0xff6f7a86u, 0xffb0b8c0u) /* mode `to` */                                \
    X(CELL, 0xffe8a25cu, 0xffa8540au,                                                              \
      0xffffb000u) /* outline of the cell; text of warnings in the window */                       \
    X(CHIP, 0xe0202020u, 0xe8f4f4f4u,                                                              \
      0xff000000u) /* background of labels over the canvas or the patch */                         \
    X(CHIP_HOT, 0xf0343434u, 0xf8ffffffu, 0xff303030u)                                             \
    X(BAD, 0xffe0694fu, 0xffb3261eu, 0xffff7a66u)     /* error message */                          \
    X(WARN, 0xffe8a25cu, 0xff4a2a00u, 0xffffb000u)    /* poor result */                            \
    X(GOOD, 0xff7fc08au, 0xff0b6b8au, 0xff7fe0b0u)    /* good result */                            \
    X(REFUSED, 0xff5a3030u, 0xfff3c9c4u, 0xff700000u) /* background of a refused action */         \
    X(LINK, 0xff78aeeau, 0xff1a5fb4u,                                                              \
      0xff6fc3ffu) /* link in the guide: brighter than the accent, for legibility */               \
    X(GROUND, 0xff2e2e2eu, 0xfff2f2f2u, 0xff181818u) /* background of code in the guide */         \
    X(MARKED, 0xff34485eu, 0xffffe9a8u, 0xff004a9cu) /* search match */                            \
    X(LINE, 0xff1a1a1au, 0xffc2c2c2u, 0xffffffffu)   /* between bars and views */                  \
    X(FOCUS, 0xff8fd0ffu, 0xff0a4fa8u, 0xff00e5ffu)  /* ring of the keyboard focus */              \
    X(LIGHT, 0xffffd873u, 0xffffd873u, 0xffffd873u)  /* light on the patch */

typedef enum WrThemeColour {
#define WR_THEME_NAME(name, dark, light, contrast) WR_THEMED_##name,
    WR_THEME_COLOURS(WR_THEME_NAME)
#undef WR_THEME_NAME
        WR_THEMED_COUNT
} WrThemeColour;

typedef enum WrThemeKind {
    WR_THEME_DARK,
    WR_THEME_LIGHT,
    WR_THEME_CONTRAST,
    WR_THEME_KINDS
} WrThemeKind;

#ifdef __cplusplus
extern "C" {
#endif

/* The present theme; initially dark. Window thread only. */
WrThemeKind wr_theme(void);
void wr_theme_set(WrThemeKind kind);
WrColour wr_theme_colour(WrThemeColour name);

/* Colours for items side by side, such as lines of a plot; distinguishable with red-green colour blindness. */
#define WR_SERIES 7
extern const WrColour wr_series[WR_SERIES]; /* blue, orange, green, violet, red, yellow, grey */

/* ---- short words in place of icons if the icon font is missing ---- */

/* One to three plain letters for a WR_ICON_...; any other text is returned unchanged. */
const char *wr_icon_word(const char *icon);

#ifdef __cplusplus
}
#endif

#define WR_COLOUR_SURROUND wr_theme_colour(WR_THEMED_SURROUND)
#define WR_COLOUR_BAR wr_theme_colour(WR_THEMED_BAR)
#define WR_COLOUR_PANEL wr_theme_colour(WR_THEMED_PANEL)
#define WR_COLOUR_FIELD wr_theme_colour(WR_THEMED_FIELD)
#define WR_COLOUR_FIELD_HOT wr_theme_colour(WR_THEMED_FIELD_HOT)
#define WR_COLOUR_EDGE wr_theme_colour(WR_THEMED_EDGE)
#define WR_COLOUR_TEXT wr_theme_colour(WR_THEMED_TEXT)
#define WR_COLOUR_LABEL wr_theme_colour(WR_THEMED_LABEL)
#define WR_COLOUR_STRONG wr_theme_colour(WR_THEMED_STRONG)
#define WR_COLOUR_MUTED wr_theme_colour(WR_THEMED_MUTED)
#define WR_COLOUR_FAINT wr_theme_colour(WR_THEMED_FAINT)
#define WR_COLOUR_OFF wr_theme_colour(WR_THEMED_OFF)
#define WR_COLOUR_ACCENT wr_theme_colour(WR_THEMED_ACCENT)
#define WR_COLOUR_SELECTED wr_theme_colour(WR_THEMED_SELECTED)
#define WR_COLOUR_FILL wr_theme_colour(WR_THEMED_FILL)
#define WR_COLOUR_FILL_HOT wr_theme_colour(WR_THEMED_FILL_HOT)
#define WR_COLOUR_ROW_HOT wr_theme_colour(WR_THEMED_ROW_HOT)
#define WR_COLOUR_ROW_SELECTED wr_theme_colour(WR_THEMED_ROW_SELECTED)
#define WR_COLOUR_ROW_CHOSEN wr_theme_colour(WR_THEMED_ROW_CHOSEN)
#define WR_COLOUR_LIST wr_theme_colour(WR_THEMED_LIST)
#define WR_COLOUR_POPUP wr_theme_colour(WR_THEMED_POPUP)
#define WR_COLOUR_BUTTON wr_theme_colour(WR_THEMED_BUTTON)
#define WR_COLOUR_BUTTON_HOT wr_theme_colour(WR_THEMED_BUTTON_HOT)
#define WR_COLOUR_GRAB wr_theme_colour(WR_THEMED_GRAB)
#define WR_COLOUR_GRAB_HOT wr_theme_colour(WR_THEMED_GRAB_HOT)
#define WR_COLOUR_GRAB_HELD wr_theme_colour(WR_THEMED_GRAB_HELD)
#define WR_COLOUR_GRID wr_theme_colour(WR_THEMED_GRID)
#define WR_COLOUR_RAISE wr_theme_colour(WR_THEMED_RAISE)
#define WR_COLOUR_LOWER wr_theme_colour(WR_THEMED_LOWER)
#define WR_COLOUR_LEVEL wr_theme_colour(WR_THEMED_LEVEL)
#define WR_COLOUR_CELL wr_theme_colour(WR_THEMED_CELL)
#define WR_COLOUR_CHIP wr_theme_colour(WR_THEMED_CHIP)
#define WR_COLOUR_CHIP_HOT wr_theme_colour(WR_THEMED_CHIP_HOT)
#define WR_COLOUR_BAD wr_theme_colour(WR_THEMED_BAD)
#define WR_COLOUR_WARN wr_theme_colour(WR_THEMED_WARN)
#define WR_COLOUR_GOOD wr_theme_colour(WR_THEMED_GOOD)
#define WR_COLOUR_REFUSED wr_theme_colour(WR_THEMED_REFUSED)
#define WR_COLOUR_LINK wr_theme_colour(WR_THEMED_LINK)
#define WR_COLOUR_GROUND wr_theme_colour(WR_THEMED_GROUND)
#define WR_COLOUR_MARKED wr_theme_colour(WR_THEMED_MARKED)
#define WR_COLOUR_FOCUS wr_theme_colour(WR_THEMED_FOCUS)
#define WR_COLOUR_LINE wr_theme_colour(WR_THEMED_LINE)
#define WR_COLOUR_LIGHT wr_theme_colour(WR_THEMED_LIGHT)
