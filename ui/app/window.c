/* The system window: created with the best driver for the display, and kept on the screen. */
#include "ui/app/window.h"
#include "system/process.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/document.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/desktop_scale.h"
#include "ui/toolkit/video_driver.h"
#include "ui/toolkit/gui.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* scale set by the desktop, or by its display, in steps of 1/4 */
static double window_scale(SDL_Window *window)
{
    float dpi = (float)wr_desktop_dpi(window);
    int display = SDL_GetWindowDisplayIndex(window);
    if (dpi == 0.0f && (display < 0 || SDL_GetDisplayDPI(display, NULL, &dpi, NULL) != 0))
        return 1.0;
    /* displays that report 97 mean 96 */
    double scale = floor((double)dpi / 96.0 * 4.0 + 0.25) / 4.0;
    return scale < 1.0 ? 1.0 : scale > 3.0 ? 3.0 : scale;
}

static bool has_gpu(void)
{
    return wr_process_has_gpu();
}

static SDL_Window *open_window(const WrApp *app)
{
    const WrAppOptions *o = app->options;
    int w = o->width > 0 ? o->width : app->settings->width;
    int h = o->height > 0 ? o->height : app->settings->height;
    SDL_Rect room;
    if (o->width <= 0 && SDL_GetDisplayUsableBounds(0, &room) == 0) {
        w = w < room.w ? w : room.w;
        h = h < room.h ? h : room.h;
    }
    Uint32 flags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_HIDDEN;
    if (app->settings->maximized && o->width <= 0) flags |= SDL_WINDOW_MAXIMIZED;
    return SDL_CreateWindow("Wrinkle", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, w, h, flags);
}

/* Try one way to present frames: true if pixels reach the screen. */
static bool try_screen(WrApp *app, WrScreenWay way)
{
    bool direct = way == WR_SCREEN_DIRECT;
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, direct ? "0" : NULL);
    SDL_SetHint(SDL_HINT_RENDER_DRIVER, way == WR_SCREEN_OPENGL ? "opengl" : NULL);
    app->window = open_window(app);
    if (!app->window) return false;
    Uint32 flags = way == WR_SCREEN_OPENGL || way == WR_SCREEN_ANY ? SDL_RENDERER_ACCELERATED
                                                                   : SDL_RENDERER_SOFTWARE;
    app->renderer = SDL_CreateRenderer(app->window, -1, flags);
    if (app->renderer && SDL_RenderClear(app->renderer) == 0) return true;
    if (app->renderer) SDL_DestroyRenderer(app->renderer);
    SDL_DestroyWindow(app->window);
    app->renderer = NULL;
    app->window = NULL;
    return false;
}

/* Try the ways from best to worst. Failures are printed to standard error; SDL_GetError has the last one. */
static bool open_screen(WrApp *app)
{
    WrScreenWay ways[WR_SCREEN_WAYS];
    const char *driver = SDL_GetCurrentVideoDriver();
    int count = wr_screen_ways(driver, has_gpu(), getenv("WRINKLE_RENDERER"), ways);
    for (int i = 0; i < count; i++) {
        if (try_screen(app, ways[i])) {
            if (i > 0)
                fprintf(stderr, "wrinkle: the window is drawn %s\n", wr_screen_words(ways[i]));
            return true;
        }
        fprintf(stderr, "wrinkle: no window drawn %s on %s: %s\n", wr_screen_words(ways[i]),
                driver ? driver : "no driver", SDL_GetError());
    }
    return false;
}

/* True if the user, a test or a measurement requests a driver, possibly one without output. */
static bool is_driver_requested(void)
{
    const char *driver = SDL_GetHint(SDL_HINT_VIDEODRIVER);
    return driver && *driver;
}

static bool fail_display(const char *why)
{
    SDL_SetError("there is no display (%s); `wrinkle render FILE -o PICTURE` needs none, and "
                 "--do COMMAND paints: `wrinkle help`",
                 why);
    return false;
}

/* Without a display SDL falls back to a driver without output or to the console; such a window could be neither seen nor
   closed. */
static bool open_display(void)
{
    const WrDisplayEnv env = wr_display_env();
    const char *driver = wr_display_driver(&env);
    const bool requested = is_driver_requested();
    if (!requested && wr_display_none(&env))
        return fail_display("DISPLAY and WAYLAND_DISPLAY are not set");
    if (driver && !requested) SDL_SetHint(SDL_HINT_VIDEODRIVER, driver);
    const bool opened = SDL_InitSubSystem(SDL_INIT_VIDEO) == 0;
    if (requested) return opened;
    if (opened &&
        !wr_display_no_output(SDL_GetHint(SDL_HINT_VIDEODRIVER), SDL_GetCurrentVideoDriver()))
        return true;
    return fail_display("neither DISPLAY nor WAYLAND_DISPLAY names one that answers");
}

static void report_display(WrApp *app)
{
    const WrDisplayEnv env = wr_display_env();
    app->display_word = wr_display_driver_message(&env, SDL_GetCurrentVideoDriver());
    if (app->display_word) fprintf(stderr, "wrinkle: %s\n", app->display_word);
}

bool wr_window_open(WrApp *app)
{
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
    SDL_SetHint(SDL_HINT_APP_NAME, "wrinkle");
    SDL_SetHint(SDL_HINT_QUIT_ON_LAST_WINDOW_CLOSE, "0");
    /* SDL turns these signals into SDL_QUIT, but only without other handlers. */
    wr_process_drop_interrupts();
    if (!open_display() || !open_screen(app)) return false;
    report_display(app);
    SDL_SetWindowMinimumSize(app->window, 640, 420);
    SDL_SetRenderDrawBlendMode(app->renderer, SDL_BLENDMODE_BLEND);
    SDL_EventState(SDL_DROPFILE, SDL_ENABLE);
    app->display_scale = window_scale(app->window);
    return true;
}

static void window_keep(WrApp *app)
{
    SDL_Rect room, now, fits;
    int top, left, bottom, right, display = SDL_GetWindowDisplayIndex(app->window);
    Uint32 flags = SDL_GetWindowFlags(app->window);
    if (app->fitted || app->options->width > 0) return;
    if (flags & (SDL_WINDOW_MAXIMIZED | SDL_WINDOW_FULLSCREEN | SDL_WINDOW_HIDDEN)) return;
    if (display < 0 || SDL_GetDisplayUsableBounds(display, &room) != 0 ||
        SDL_GetWindowBordersSize(app->window, &top, &left, &bottom, &right) != 0)
        return;
    SDL_GetWindowPosition(app->window, &now.x, &now.y);
    SDL_GetWindowSize(app->window, &now.w, &now.h);
    if (!wr_layout_window(&room, &now, (const int[4]){ left, top, right, bottom }, &fits)) return;
    SDL_SetWindowSize(app->window, fits.w, fits.h);
    SDL_SetWindowPosition(app->window, fits.x, fits.y);
}

static void window_event(WrApp *app, const SDL_WindowEvent *event)
{
    switch (event->event) {
    case SDL_WINDOWEVENT_HIDDEN:
    case SDL_WINDOWEVENT_MINIMIZED: app->visible = false; break;
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_RESTORED:
        app->visible = true;
        window_keep(app);
        break;
    case SDL_WINDOWEVENT_MOVED: window_keep(app); break;
    case SDL_WINDOWEVENT_MAXIMIZED:
        app->visible = true;
        app->settings->maximized = true;
        break;
    case SDL_WINDOWEVENT_FOCUS_LOST:
        wr_gui_release_all(app->gui);
        app->hand->space = false;
        break;
    case SDL_WINDOWEVENT_LEAVE:
        if (app->hand->grab == WR_GRAB_NONE) app->hand->on_canvas = app->hand->on_patch = false;
        break;
    case SDL_WINDOWEVENT_CLOSE: wr_app_quit(app); break;
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        if (!(SDL_GetWindowFlags(app->window) & SDL_WINDOW_MAXIMIZED))
            app->settings->maximized = false;
        break;
    case SDL_WINDOWEVENT_FOCUS_GAINED: /* the desktop's scale may have changed */
    case SDL_WINDOWEVENT_DISPLAY_CHANGED: app->display_scale = window_scale(app->window); break;
    default: break;
    }
}

void wr_window_event(WrApp *app, const SDL_Event *event)
{
    if (event->type == SDL_WINDOWEVENT) window_event(app, &event->window);
}
