/* guide.h - the help of the window: the pages of ui/guide, and the keys as they are set. */
#pragma once
#include "ui/state/app_state.h"

typedef struct WrText WrText;

typedef struct WrGuide WrGuide;

void wr_guide_free(WrApp *app);
/* The page of keys as Markdown: those of every action that has any. */
void wr_guide_keys(const WrApp *app, WrText *text);
/* In the dialog: search, pages and the page that is open, so many pixels tall. */
void wr_guide_show(WrApp *app, double tall);
