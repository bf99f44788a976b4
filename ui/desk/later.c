/* What is asked for inside a picture of the window is done after it: the window is first drawn without the dialog or
   the menu that asked. */
#include "ui/desk/later.h"
#include "ui/desk/desk.h"

#include "base/array.h"
#include "base/memory.h"
#include "system/clock.h"

void wr_later(WrApp *app, WrLaterWork *work, const char *text)
{
    WrLater *later = app->later;
    int i = 0;
    while (i < later->items.count && later->items.data[i].work != work) i++;
    if (i < later->items.count) wr_free(later->items.data[i].text); /* the newest of a kind */
    else wr_array_push(&later->items, ((WrLaterItem){ .work = work }));
    later->items.data[i].text = wr_strdup(text);
    later->since = wr_clock_seconds();
    wr_app_redraw(app);
}

bool wr_later_waits(const WrApp *app, WrLaterWork *work)
{
    for (int i = 0; i < app->later->items.count; i++)
        if (!work || app->later->items.data[i].work == work) return true;
    return false;
}

void wr_later_run(WrApp *app)
{
    WrLater later = *app->later;
    if (later.items.count == 0 || (app->visible && app->drawn_at <= later.since)) return;
    *app->later = (WrLater){ 0 };
    for (int i = 0; i < later.items.count; i++) {
        later.items.data[i].work(app, later.items.data[i].text);
        wr_free(later.items.data[i].text);
    }
    wr_array_free(&later.items);
    wr_app_redraw(app);
}

void wr_later_free(WrApp *app)
{
    for (int i = 0; i < app->later->items.count; i++) wr_free(app->later->items.data[i].text);
    wr_array_free(&app->later->items);
}
