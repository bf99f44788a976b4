/* Queue of actions requested during a background command: run in order afterwards, or dropped with a message. */
#include "ui/state/busy_internal.h"
#include "ui/state/app_state.h"
#include "ui/state/messages.h"
#include "ui/state/session_view.h"

#include "base/array.h"
#include "base/hash.h"
#include "base/memory.h"
#include "document/document.h"

#include <stdio.h>
#include <string.h>

/* Lines refer to layers by number, so another set or order of layers must change the key. */
static uint64_t layers_key(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    WrHash hash = { .low = (uint64_t)document->layer_count };
    for (int i = 0; i < document->layer_count; i++)
        hash = wr_hash_bytes(document->layers[i].name, strlen(document->layers[i].name), hash);
    return hash.low | 1;
}

void wr_busy_put_off(WrApp *app, const char *words, WrBusyLate *late, const char *text,
                     bool of_layers)
{
    wr_array_push(&app->waits->items, ((WrWaiting){ .late = late,
                                                    .text = wr_strdup(text),
                                                    .words = wr_strdup(words),
                                                    .layers = of_layers ? layers_key(app) : 0 }));
    wr_app_redraw(app);
}

static WrWaiting take(WrWaits *waits, int index)
{
    WrWaiting taken = waits->items.data[index];
    waits->items.count--;
    memmove(waits->items.data + index, waits->items.data + index + 1,
            (size_t)(waits->items.count - index) * sizeof *waits->items.data);
    return taken;
}

static void fini(WrWaiting *waiting)
{
    wr_free(waiting->text);
    wr_free(waiting->words);
}

void wr_busy_take_back(WrApp *app, WrBusyLate *late, const char *text)
{
    WrWaits *waits = app->waits;
    for (int i = waits->items.count - 1; i >= 0; i--) {
        if (waits->items.data[i].late != late || strcmp(waits->items.data[i].text, text) != 0)
            continue;
        WrWaiting taken = take(waits, i);
        fini(&taken);
        wr_app_redraw(app);
        return;
    }
}

void wr_waits_words(const WrApp *app, const char *between, char *text, size_t size)
{
    const WrWaits *waits = app->waits;
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < waits->items.count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? between : "",
                                 waits->items.data[i].words);
}

void wr_waits_drop(WrApp *app, WrDropped why)
{
    char words[300];
    if (app->waits->items.count == 0) return;
    wr_waits_words(app, ", ", words, sizeof words);
    while (app->waits->items.count > 0) {
        WrWaiting first = take(app->waits, 0);
        first.late(app, first.text, true);
        fini(&first);
    }
    if (why == WR_DROPPED_CANCELLED)
        wr_app_say(app, "Cancelled, with the actions that waited for it: %s", words);
    if (why == WR_DROPPED_LAYERS)
        wr_app_say(app, "Not done, since the layers are others now: %s", words);
    if (why == WR_DROPPED_WISH) wr_app_say(app, "Not done any more: %s", words);
}

void wr_waits_run(WrApp *app)
{
    WrWaits *waits = app->waits;
    if (waits->running) return;
    if (waits->given_up) wr_waits_drop(app, WR_DROPPED_CANCELLED);
    waits->given_up = false;
    waits->running = true;
    while (waits->items.count > 0 && !app->busy) {
        if (waits->items.data[0].layers && waits->items.data[0].layers != layers_key(app)) {
            wr_waits_drop(app, WR_DROPPED_LAYERS);
            break;
        }
        WrWaiting first = take(waits, 0);
        first.late(app, first.text, false);
        fini(&first);
        if (waits->given_up) break;
    }
    waits->running = false;
}

void wr_busy_free(WrApp *app)
{
    for (int i = 0; i < app->waits->items.count; i++) fini(&app->waits->items.data[i]);
    wr_array_free(&app->waits->items);
}
