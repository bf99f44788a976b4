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
