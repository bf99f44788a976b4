#include "image/module_path.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/oiio.h"
#include "system/shared_object.h"
#include "system/path.h"
#include "system/thread.h"

/* Folder of the installed modules relative to the program's folder; set by the build. */
#ifndef WR_MODULE_FOLDER
#define WR_MODULE_FOLDER "../lib/wrinkle"
#endif
/* threads needed at once; log4cplus, a dependency of OpenCV, starts 4 */
#define WR_MODULE_THREADS 8

bool wr_module_path(int place, const char *file, WrText *path)
{
    const char *given = getenv("WRINKLE_MODULES");
    char *program = wr_program_folder();
    wr_text_clear(path);
    if (place == 0) wr_text_addf(path, "%s/%s", program, file);
    if (place == 1) wr_text_addf(path, "%s/" WR_MODULE_FOLDER "/%s", program, file);
    if (place == 2 && given && *given) wr_text_addf(path, "%s/%s", given, file);
    wr_free(program);
    return path->length > 0;
}

/* The table of a module, NULL if there is none of that version. The module stays loaded: OpenImageIO
   cannot be unloaded safely. */
static const void *load(const WrModule *module, WrError *err)
{
    const int *table = NULL;
    WrText path = { 0 }, looked = { 0 }, reason = { 0 };
    for (int place = 0; place < WR_MODULE_PLACES && !table; place++) {
        if (!wr_module_path(place, module->file, &path)) continue;
        wr_text_addf(&looked, "%s%s", looked.length ? ", " : "", wr_text_get(&path));
        if (!wr_path_is_there(wr_text_get(&path))) continue;
        void *library = wr_object_open(wr_text_get(&path));
        if (!library) {
            wr_text_clear(&reason);
            wr_text_add(&reason, wr_object_why());
            wr_text_addf(&looked, " (%s)", wr_text_get(&reason));
            continue;
        }
        table = wr_object_find(library, module->symbol);
        if (!table || *table != module->version) {
            table = NULL;
            wr_text_addf(&looked, " (of another version of the program)");
            wr_object_close(library);
        }
    }
    if (!table && reason.length > 0 && module->package && *module->package)
        wr_fail(err,
                "%s need the module %s, which cannot be loaded: %s (on Debian: apt install %s)",
                module->serves, module->file, wr_text_get(&reason), module->package);
    else if (!table)
        wr_fail(err, "%s need the module %s, which was not found at: %s", module->serves,
                module->file, wr_text_get(&looked));
    wr_text_fini(&path);
    wr_text_fini(&reason);
    wr_text_fini(&looked);
    return table;
}

static void *wait_for_all(void *lock)
{
    wr_mutex_lock(lock);
    wr_mutex_unlock(lock);
    return NULL;
}

/* Libraries used by the modules start threads when they are loaded, and abort the program if that
 * fails. */
static bool threads_are_left(void)
{
    WrMutex lock = WR_MUTEX_READY;
    WrThread threads[WR_MODULE_THREADS];
    int count = 0;
    wr_mutex_lock(&lock);
    while (count < WR_MODULE_THREADS && wr_thread_begin(&threads[count], wait_for_all, &lock))
        count++;
    wr_mutex_unlock(&lock);
    for (int i = 0; i < count; i++) wr_thread_join(threads[i]);
    return count == WR_MODULE_THREADS;
}

bool wr_module_load(void *ctx, WrError *err)
{
    WrModule *module = ctx;
    if (module->quiet || threads_are_left()) return (module->table = load(module, err)) != NULL;
    return wr_fail(err,
                   "%s need threads, but the system allows no more: close another program first",
                   module->serves);
}

static bool sealed;

void wr_modules_seal(void)
{
    sealed = true;
}

const void *wr_module_table(WrModule *module, WrError *err)
{
    const WrError *why = &module->loading.why;
    if (sealed && !module->table && why->text[0]) {
        wr_fail(err, "%s", wr_error_message(why));
        return NULL;
    }
    return wr_once_async_wait(&module->loading, err) ? module->table : NULL;
}

static WrModule oiio = { .file = "wrinkle_oiio.so",
                         .serves = "picture files",
                         .package = WR_OIIO_PACKAGE,
                         .symbol = WR_OIIO_SYMBOL,
                         .version = WR_OIIO_VERSION,
                         .loading = { .work = wr_module_load, .ctx = &oiio } };

void wr_oiio_warm(void)
{
    wr_once_async_begin(&oiio.loading);
}

const WrCodec *wr_oiio(WrError *err)
{
    return wr_module_table(&oiio, err);
}
