#include "ui/app/input.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/toolkit/gui.h"

#include "base/array.h"
#include "base/memory.h"

#include <string.h>

/* Kinds of events that wait for a frame. */
typedef enum WrInputHold {
    WR_INPUT_FREE,
    WR_INPUT_TYPING, /* all except keys and letters: the widgets keep their order themselves */
    WR_INPUT_WHEEL,  /* all except wheel events */
    WR_INPUT_ALL
} WrInputHold;

typedef struct WrInputItem {
    SDL_Event event;
    unsigned widget; /* of a press: identifier of the widget on the screen at its position */
} WrInputItem;

struct WrInput {
    WR_ARRAY(WrInputItem) items;
    int first;   /* index of the first unhandled item */
    int waiting; /* number of unhandled items; atomic: tests read it from another thread */
    WrInputHold hold;
    bool key_before; /* the previous event was a key press: its letters belong to it */
    bool dropped[8]; /* buttons whose press was dropped: their release is dropped too */
};

WrInput *wr_input_new(void)
{
    return wr_alloc(1, sizeof(WrInput));
}

void wr_input_free(WrInput *input)
{
    if (!input) return;
    for (int i = input->first; i < input->items.count; i++)
        if (input->items.data[i].event.type == SDL_DROPFILE)
            SDL_free(input->items.data[i].event.drop.file);
    wr_array_free(&input->items);
    wr_free(input);
}

bool wr_input_waits(const WrApp *app)
{
    return __atomic_load_n(&app->hand->input->waiting, __ATOMIC_ACQUIRE) > 0;
}

void wr_input_collect(WrApp *app)
{
    WrInput *input = app->hand->input;
    WrInputItem item = { .widget = 0 };
    if (input->first == input->items.count) input->first = input->items.count = 0;
    const int before = input->items.count;
    SDL_PumpEvents();
    /* more than zero during the transfer */
    __atomic_fetch_add(&input->waiting, 1, __ATOMIC_RELEASE);
    while (SDL_PeepEvents(&item.event, 1, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT) > 0) {
        item.widget = item.event.type == SDL_MOUSEBUTTONDOWN
                          ? wr_gui_widget_at(app->gui, item.event.button.x, item.event.button.y)
                          : 0;
        wr_array_push(&input->items, item);
    }
    __atomic_fetch_add(&input->waiting, input->items.count - before - 1, __ATOMIC_RELEASE);
}

/* ---- effect of an event on the focus ---- */

static bool is_modifier(SDL_Scancode code)
{
    return code >= SDL_SCANCODE_LCTRL && code <= SDL_SCANCODE_RGUI;
}

/* True for a key whose effect stays within the edited text. */
static bool edits_text(const SDL_Keysym *key)
{
    const SDL_Scancode code = key->scancode;
    const bool leaves = code == SDL_SCANCODE_RETURN || code == SDL_SCANCODE_KP_ENTER ||
                        code == SDL_SCANCODE_ESCAPE || code == SDL_SCANCODE_TAB ||
                        (code >= SDL_SCANCODE_F1 && code <= SDL_SCANCODE_F12);
    return !leaves && !(key->mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI));
}

static bool widgets_listen(const WrApp *app)
{
    return wr_gui_wants_text(app->gui) || wr_gui_popup_open_now(app->gui) ||
           app->dialog->now != WR_DIALOG_NONE;
}

static WrInputHold after_key(const WrApp *app, const SDL_KeyboardEvent *key)
{
    if (is_modifier(key->keysym.scancode)) return WR_INPUT_FREE;
    if (wr_gui_wants_text(app->gui) && edits_text(&key->keysym)) return WR_INPUT_TYPING;
    /* A repeated key, such as one for the brush's size, cannot open a widget. */
    return key->repeat && !widgets_listen(app) ? WR_INPUT_FREE : WR_INPUT_ALL;
}

static WrInputHold after_button(const WrApp *app, const SDL_MouseButtonEvent *button)
{
    const bool on_view = !wr_gui_owns_point(app->gui, button->x, button->y) &&
                         !wr_gui_holds_mouse(app->gui) && !widgets_listen(app);
    return on_view ? WR_INPUT_FREE : WR_INPUT_ALL;
}

static WrInputHold hold_after(const WrApp *app, const SDL_Event *event)
{
    switch (event->type) {
    case SDL_KEYDOWN: return after_key(app, &event->key);
    case SDL_TEXTINPUT: return wr_gui_wants_text(app->gui) ? WR_INPUT_TYPING : WR_INPUT_FREE;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP: return after_button(app, &event->button);
    case SDL_MOUSEWHEEL:
        return wr_gui_owns_point(app->gui, app->hand->x, app->hand->y) ? WR_INPUT_WHEEL
                                                                       : WR_INPUT_FREE;
    default: return WR_INPUT_FREE;
    }
}

/* ---- order of events ---- */

static bool of_keys(const SDL_Event *event)
{
    return event->type == SDL_KEYDOWN || event->type == SDL_KEYUP || event->type == SDL_TEXTINPUT;
}

static bool passes(const WrInput *input, const SDL_Event *event)
{
    if (event->type == SDL_TEXTINPUT && input->key_before) return true;
    switch (input->hold) {
    case WR_INPUT_FREE: return true;
    case WR_INPUT_TYPING: return of_keys(event);
    case WR_INPUT_WHEEL: return event->type == SDL_MOUSEWHEEL;
    case WR_INPUT_ALL: break;
    }
    return false;
}

/* True for a press at a position where another widget is now, and for its release. */
static bool is_stale(WrApp *app, const WrInputItem *item)
{
    WrInput *input = app->hand->input;
    const SDL_MouseButtonEvent *button = &item->event.button;
    const int which = button->button & 7;
    bool stale = false;
    if (item->event.type == SDL_MOUSEBUTTONDOWN)
        stale = input->dropped[which] =
            item->widget != wr_gui_widget_at(app->gui, button->x, button->y);
    else if (item->event.type == SDL_MOUSEBUTTONUP) {
        stale = input->dropped[which];
        input->dropped[which] = false;
    }
    return stale;
}

/* Record the modifier keys and the pointer position after the event. */
static void note_state(WrInputRouter *hand, const SDL_Event *event)
{
    if (event->type == SDL_KEYDOWN || event->type == SDL_KEYUP)
        hand->mods = wr_key_mods((SDL_Keymod)event->key.keysym.mod);
    if (event->type == SDL_MOUSEMOTION) hand->x = event->motion.x, hand->y = event->motion.y;
    if (event->type == SDL_MOUSEBUTTONDOWN || event->type == SDL_MOUSEBUTTONUP)
        hand->x = event->button.x, hand->y = event->button.y;
}

bool wr_input_next(WrApp *app, SDL_Event *event)
{
    WrInput *input = app->hand->input;
    if (!app->visible) input->hold = WR_INPUT_FREE; /* no frame will follow */
    while (wr_input_waits(app)) {
        const WrInputItem item = input->items.data[input->first];
        if (!passes(input, &item.event)) return false;
        input->first++;
        __atomic_fetch_sub(&input->waiting, 1, __ATOMIC_RELEASE);
        if (is_stale(app, &item)) continue;
        *event = item.event;
        note_state(app->hand, event);
        return true;
    }
    return false;
}

void wr_input_handled(WrApp *app, const SDL_Event *event)
{
    WrInput *input = app->hand->input;
    const WrInputHold hold = hold_after(app, event);
    if (hold > input->hold) input->hold = hold;
    input->key_before = of_keys(event) && event->type != SDL_KEYUP;
}

void wr_input_shown(WrApp *app)
{
    app->hand->input->key_before = false;
    if (!wr_gui_unsettled(app->gui)) app->hand->input->hold = WR_INPUT_FREE;
}
