/* Actions requested inside a frame run after it, when the window has been drawn without the dialog or menu that
   requested them. */
#include "ui/state/deferred_actions.h"
#include "ui/state/app_state.h"

#include "base/array.h"
#include "base/memory.h"
#include "system/clock.h"

void wr_deferred(WrApp *app, WrDeferredWork *work, const char *text)
{
    WrDeferred *later = app->later;
    int i = 0;
    while (i < later->items.count && later->items.data[i].work != work) i++;
    if (i < later->items.count)
        wr_free(later->items.data[i].text); /* only the newest of a kind stays */
    else wr_array_push(&later->items, ((WrDeferredItem){ .work = work }));
    later->items.data[i].text = wr_strdup(text);
    later->since = wr_clock_seconds();
    wr_app_redraw(app);
}

bool wr_deferred_waits(const WrApp *app, WrDeferredWork *work)
{
    for (int i = 0; i < app->later->items.count; i++)
        if (!work || app->later->items.data[i].work == work) return true;
    return false;
}

void wr_deferred_run(WrApp *app)
{
    WrDeferred later = *app->later;
    if (later.items.count == 0 || (app->visible && app->drawn_at <= later.since)) return;
    *app->later = (WrDeferred){ 0 };
    for (int i = 0; i < later.items.count; i++) {
        later.items.data[i].work(app, later.items.data[i].text);
        wr_free(later.items.data[i].text);
    }
    wr_array_free(&later.items);
    wr_app_redraw(app);
}

void wr_deferred_free(WrApp *app)
{
    for (int i = 0; i < app->later->items.count; i++) wr_free(app->later->items.data[i].text);
    wr_array_free(&app->later->items);
}
