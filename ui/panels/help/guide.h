/* guide.h - help browser: the pages of ui/guide, and a page of the present keys. */
#pragma once
#include "ui/app/state/app_state.h"

#include <stdbool.h>

typedef struct WrText WrText;

typedef struct WrGuide WrGuide;

void wr_guide_free(WrApp *app);
/* The page of keys as Markdown: the keys of every action. */
void wr_guide_keys(const WrApp *app, WrText *text);
/* The command whose Run was clicked and whose effect is shown, until it runs or is cancelled; NULL: none. */
const char *wr_guide_proposed(const WrApp *app);
/* Where the Run of a command of the page was drawn last, pixels of the window; false: it is not seen. */
bool wr_guide_run_place(const WrApp *app, const char *line, int *x, int *y);

/* Each page, with heading NULL, and each of its headings. The texts are valid until the guide is freed. */
void wr_guide_headings(WrApp *app,
                       void (*each)(void *ctx, const char *page, const char *title,
                                    const char *heading),
                       void *ctx);
/* Open the guide at "PAGE#HEADING", or at a page "PAGE#". */
void wr_guide_open(WrApp *app, const char *place);

/* ---- commands of the guide's pages that run in the window ---- */

/* Which lines of code are commands, and the sentence that describes the effect of a line. */

/* Whether a line of code is a command of the language; lines for a shell are not. */
bool wr_guide_is_command(const char *line);
/* What a command would do to the document or the disk, in the window's language; added to out. */
void wr_guide_effect(const WrApp *app, const char *line, WrText *out);

/* ---- dialogs of the guide and of information about the program ---- */

void wr_dialog_help(WrApp *app);
