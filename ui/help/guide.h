/* guide.h - help browser: the pages of ui/guide, and a page of the present keys. */
#pragma once
#include "ui/state/app_state.h"

typedef struct WrText WrText;

typedef struct WrGuide WrGuide;

void wr_guide_free(WrApp *app);
/* The page of keys as Markdown: the keys of every action. */
void wr_guide_keys(const WrApp *app, WrText *text);
/* Content of the dialog: search, list of pages and the open page, with that height in pixels. */
void wr_guide_show(WrApp *app, double tall);
/* The command whose Run was clicked and whose effect is shown, until it runs or is cancelled; NULL: none. */
const char *wr_guide_proposed(const WrApp *app);
/* Where the Run of a command of the page was drawn last, pixels of the window; false: it is not seen. */
bool wr_guide_run_place(const WrApp *app, const char *line, int *x, int *y);
