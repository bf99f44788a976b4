/* SPDX-License-Identifier: MIT */
#include "ui/accuracy_choice.h"

/* Cheap to good. */
static int scheme_rank(WrScheme scheme)
{
    switch (scheme) {
    case WR_SCHEME_BSPLINE_FIT: return 5;
    case WR_SCHEME_CATMULL: return 4;
    case WR_SCHEME_BSPLINE: return 3;
    case WR_SCHEME_CENTRAL: return 2;
    case WR_SCHEME_BILINEAR: return 1;
    default: return 0;
    }
}

/* Samples of a pixel. */
static int grid(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_SUPERSAMPLE ? scene->dials.samples : 1;
}

void wr_chosen_from(const WrChoice *choice, WrChosen *out)
{
    const WrScene *slopes = NULL, *normal = NULL, *samples = NULL;
    *out = (WrChosen){ .any = choice->kinds > 0, .met = choice->met };
    for (int k = 1; k < choice->kinds; k++) { /* 0 is empty */
        const WrScene *s = choice->scenes[k];
        if (choice->blocks[k] == 0) continue;
        if (!slopes || scheme_rank(s->scheme) > scheme_rank(slopes->scheme)) slopes = s;
        if (!normal || s->bump > normal->bump) normal = s;
        if (!samples || grid(s) > grid(samples)) samples = s;
    }
    if (!slopes) {
        out->any = false;
        return;
    }
    for (int d = 0; d < WR_DIAL_COUNT; d++) out->finest[d] = wr_dials[d].get(samples);
    out->finest[WR_DIAL_SCHEME] = slopes->scheme;
    out->finest[WR_DIAL_NORMAL] = normal->bump;
    WrText lines = { 0 };
    wr_choice_print(choice, &lines);
    snprintf(out->reason, sizeof out->reason, "%s", choice->reason);
    snprintf(out->lines, sizeof out->lines, "%s", wr_text_get(&lines));
    wr_text_fini(&lines);
}
