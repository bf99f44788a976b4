#include "image/module.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/oiio.h"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#define MODULE_FILE "wrinkle_oiio.so"

/* Where the installed module lies, seen from the program's folder; the build sets it. */
#ifndef WR_MODULE_FOLDER
#define WR_MODULE_FOLDER "../lib/wrinkle"
#endif

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

static const WrOiioTable *load(WrError *err)
{
    const WrOiioTable *table = NULL;
    WrText path = { 0 }, looked = { 0 };
    for (int place = 0; place < WR_MODULE_PLACES && !table; place++) {
        if (!wr_module_path(place, MODULE_FILE, &path)) continue;
        wr_text_addf(&looked, "%s%s", looked.length ? ", " : "", wr_text_get(&path));
        if (access(wr_text_get(&path), F_OK) != 0) continue;
        void *module = dlopen(wr_text_get(&path), RTLD_NOW | RTLD_LOCAL);
        if (!module) {
            wr_text_addf(&looked, " (%s)", dlerror());
            continue;
        }
        const WrOiioTable *found = dlsym(module, WR_OIIO_SYMBOL);
        if (found && found->version == WR_OIIO_VERSION) {
            table = found; /* stays loaded: OpenImageIO does not like to be unloaded */
        } else {
            wr_text_addf(&looked, " (of another version of the program)");
            dlclose(module);
        }
    }
    if (!table)
        wr_fail(err, "picture files need the module " MODULE_FILE ", looked for at: %s",
                wr_text_get(&looked));
    wr_text_fini(&path);
    wr_text_fini(&looked);
    return table;
}

/* The one thing here that outlives a call: which module is loaded is a fact of the process. A failure
   is not kept, so that a later call may succeed. */
const WrOiioTable *wr_oiio(WrError *err)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static const WrOiioTable *loaded;
    pthread_mutex_lock(&lock);
    if (!loaded) loaded = load(err);
    const WrOiioTable *table = loaded;
    pthread_mutex_unlock(&lock);
    return table;
}
