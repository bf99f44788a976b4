/* wr_app_run of the program wrinkle: loads the window on need. wrinkle-bench is linked with the window instead. */
#include "base/error.h"
#include "cli/cli.h"
#include "image/module_path.h"
#include "ui/app/app.h"

#include <stdio.h>

int wr_app_run(const WrAppOptions *options)
{
    static WrModule window = { .file = "wrinkle_window.so",
                               .serves = "windows",
                               .package = WR_SDL_PACKAGE,
                               .symbol = WR_WINDOW_SYMBOL,
                               .version = WR_WINDOW_VERSION,
                               .quiet = true };
    WrError err;
    if (window.table || wr_module_load(&window, &err))
        return ((const WrWindowModule *)window.table)->run(options);
    fprintf(stderr, "wrinkle: %s\n", err.text);
    return WR_EXIT_FAILED;
}
