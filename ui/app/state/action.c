/* Named actions. */
#include "ui/app/state/action.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/document.h"
#include "system/clock.h"

#include <string.h>

const WrAction *wr_action_find(const WrApp *app, const char *name)
{
    for (const WrAction *a = app->registry->actions; a->name; a++)
        if (strcmp(a->name, name) == 0) return a;
    return NULL;
}

const char *wr_action_help(const WrApp *app, const WrAction *action)
{
    return app->registry->helps[action - app->registry->actions];
}

/* Checks the active layer; false, with the reason. */
static bool layer_fits(const WrApp *app, const WrAction *action, WrError *err)
{
    switch (action->layer) {
    case WR_ACTION_UNLOCKED:
        return wr_session_check_unlocked(app->session, wr_app_document(app)->active, err);
    case WR_ACTION_PAINTABLE: return wr_session_check_layer(app->session, err);
    case WR_ACTION_ANY_LAYER: break;
    }
    return true;
}

bool wr_action_can(const WrApp *app, const WrAction *action)
{
    WrError err;
    if (action->waits && wr_busy_refuses(app)) return wr_busy_lets_wait(app);
    if (action->edits && wr_busy_greys(app)) return false;
    return (!action->enabled || action->enabled(app)) && layer_fits(app, action, &err);
}

/* Run a queued action. */
static void run_late(WrApp *app, const char *name, bool dropped)
{
    const WrAction *action = wr_action_find(app, name);
    if (!dropped && wr_action_can(app, action)) action->run(app);
}

/* True if the action cannot run because of a background command: it is queued, or refused with a message. */
static bool is_held_up(WrApp *app, const WrAction *action)
{
    if (!action->waits || !wr_busy_refuses(app) || !wr_busy_lets_wait(app))
        return action->edits && wr_busy_refuse(app);
    wr_busy_put_off(app, wr_words(action->label), run_late, action->name, false);
    return true;
}

static void run_now(WrApp *app, const char *name)
{
    const WrAction *action = wr_action_find(app, name);
    if (action && is_held_up(app, action)) return;
    if (action && wr_action_can(app, action)) action->run(app);
    wr_app_redraw(app);
}

void wr_action_run(WrApp *app, const char *name)
{
    const WrAction *action = wr_action_find(app, name);
    if (action && is_held_up(app, action)) return;
    for (WrActionFamily *const *f = app->registry->families; !action && *f; f++)
        if ((*f)(app, name)) break;
    WrError err;
    if (action && !layer_fits(app, action, &err)) wr_app_say_why(app, &err);
    if (!action || !wr_action_can(app, action)) return;
    if (app->in_frame) wr_deferred(app, run_now, name); /* the action may take long */
    else run_now(app, name);
}

/* Actions requested inside a frame run after it, when the window has been drawn without the dialog or menu that
   requested them. */

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
