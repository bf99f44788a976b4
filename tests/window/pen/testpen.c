/* Xorg input driver for tests: pens and a touch screen controlled by a script through a Unix socket (options
   SocketPath, ToolType: STYLUS, ERASER or TOUCH). X and Y of 0..65535 cover the whole screen. Lines:

     m X Y P TX TY [TURN]           move; pressure P of 0..65535, tilt -64..63, turn -900..899
     b BUTTON 0|1 X Y P TX TY [TURN]    a button
     t begin|update|end X Y [ID]        a finger
     s                       answer "ok": all earlier lines are done */
#include <xorg-server.h>

#include <exevents.h>
#include <xf86.h>
#include <xf86Xinput.h>
#include <xserver-properties.h>

#include <X11/Xatom.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#define AXES 6 /* the last may be left out in lines */

typedef struct Driver {
    int listener, client; /* -1: none */
    Bool touch;
    char *tool;
    char line[256];
    size_t length;
} Driver;

static void nop(InputInfoPtr info)
{
    (void)info;
}

static void nop_control(DeviceIntPtr device, PtrCtrl *control)
{
    (void)device, (void)control;
}

/* ---- lines ---- */

static void post_motion(InputInfoPtr info, const double v[AXES])
{
    ValuatorMask *mask = valuator_mask_new(AXES);
    for (int i = 0; i < AXES; i++) valuator_mask_set_double(mask, i, v[i]);
    xf86PostMotionEventM(info->dev, Absolute, mask);
    valuator_mask_free(&mask);
}

static void post_button(InputInfoPtr info, int button, int down, const double v[AXES])
{
    ValuatorMask *mask = valuator_mask_new(AXES);
    for (int i = 0; i < AXES; i++) valuator_mask_set_double(mask, i, v[i]);
    xf86PostButtonEventM(info->dev, Absolute, button, down, mask);
    valuator_mask_free(&mask);
}

static void post_touch(InputInfoPtr info, const char *event, double x, double y, unsigned id)
{
    ValuatorMask *mask = valuator_mask_new(2);
    valuator_mask_set_double(mask, 0, x);
    valuator_mask_set_double(mask, 1, y);
    xf86PostTouchEvent(info->dev, id + 1,
                       strcmp(event, "begin") == 0 ? XI_TouchBegin
                       : strcmp(event, "end") == 0 ? XI_TouchEnd
                                                   : XI_TouchUpdate,
                       0, mask);
    valuator_mask_free(&mask);
}

static void run_line(InputInfoPtr info, Driver *driver)
{
    double v[AXES] = { 0 };
    char event[16];
    int button, down;
    unsigned finger = 0;
    const char *line = driver->line;
    if (sscanf(line, "m %lf %lf %lf %lf %lf %lf", &v[0], &v[1], &v[2], &v[3], &v[4], &v[5]) >=
        AXES - 1)
        post_motion(info, v);
    else if (sscanf(line, "b %d %d %lf %lf %lf %lf %lf %lf", &button, &down, &v[0], &v[1], &v[2],
                    &v[3], &v[4], &v[5]) >= AXES + 1)
        post_button(info, button, down, v);
    else if (driver->touch && sscanf(line, "t %15s %lf %lf %u", event, &v[0], &v[1], &finger) >= 3)
        post_touch(info, event, v[0], v[1], finger);
    else if (strcmp(line, "s") == 0) (void)!write(driver->client, "ok\n", 3);
    else xf86IDrvMsg(info, X_ERROR, "not understood: %s\n", line);
}

static void leave(Driver *driver)
{
    if (driver->client < 0) return;
    RemoveNotifyFd(driver->client);
    close(driver->client);
    driver->client = -1;
}

static void on_data(int fd, int ready, void *data)
{
    DeviceIntPtr device = data;
    InputInfoPtr info = device->public.devicePrivate;
    Driver *driver = info->private;
    char bytes[4096];
    (void)ready;
    ssize_t n = read(fd, bytes, sizeof bytes);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) {
        leave(driver);
        return;
    }
    for (ssize_t i = 0; i < n; i++) {
        if (bytes[i] != '\n') {
            if (driver->length + 1 < sizeof driver->line) driver->line[driver->length++] = bytes[i];
            continue;
        }
        driver->line[driver->length] = '\0';
        driver->length = 0;
        run_line(info, driver);
    }
}

static void on_connect(int fd, int ready, void *data)
{
    DeviceIntPtr device = data;
    InputInfoPtr info = device->public.devicePrivate;
    Driver *driver = info->private;
    (void)ready;
    leave(driver);
    driver->length = 0;
    driver->client = accept(fd, NULL, NULL);
    if (driver->client >= 0) SetNotifyFd(driver->client, on_data, X_NOTIFY_READ, device);
}

/* ---- the device ---- */

static void make_pen(DeviceIntPtr device, const char *tool)
{
    static const char *const labels[AXES] = {
        AXIS_LABEL_PROP_ABS_X,      AXIS_LABEL_PROP_ABS_Y,      AXIS_LABEL_PROP_ABS_PRESSURE,
        AXIS_LABEL_PROP_ABS_TILT_X, AXIS_LABEL_PROP_ABS_TILT_Y, AXIS_LABEL_PROP_ABS_WHEEL
    };
    static const int low[AXES] = { 0, 0, 0, -64, -64, -900 };
    static const int high[AXES] = { 65535, 65535, 65535, 63, 63, 899 };
    unsigned char map[8] = { 0, 1, 2, 3, 4, 5, 6, 7 };
    Atom buttons[7] = { 0 }, axes[AXES];
    for (int i = 0; i < AXES; i++) axes[i] = XIGetKnownProperty(labels[i]);
    InitPointerDeviceStruct((DevicePtr)device, map, 7, buttons, nop_control, GetMotionHistorySize(),
                            AXES, axes);
    for (int i = 0; i < AXES; i++)
        xf86InitValuatorAxisStruct(device, i, axes[i], low[i], high[i], 1, 1, 1, Absolute);
    InitProximityClassDeviceStruct(device);
    Atom value = MakeAtom(tool, strlen(tool), TRUE);
    XIChangeDeviceProperty(device, MakeAtom("Wacom Tool Type", 15, TRUE), XA_ATOM, 32,
                           PropModeReplace, 1, &value, FALSE);
}

static void make_touch(DeviceIntPtr device)
{
    unsigned char map[2] = { 0, 1 };
    Atom button = 0, axes[2] = { XIGetKnownProperty(AXIS_LABEL_PROP_ABS_MT_POSITION_X),
                                 XIGetKnownProperty(AXIS_LABEL_PROP_ABS_MT_POSITION_Y) };
    InitPointerDeviceStruct((DevicePtr)device, map, 1, &button, nop_control, GetMotionHistorySize(),
                            2, axes);
    InitTouchClassDeviceStruct(device, 5, XIDirectTouch, 2);
    for (int i = 0; i < 2; i++)
        xf86InitValuatorAxisStruct(device, i, axes[i], 0, 65535, 1, 1, 1, Absolute);
}

static int control(DeviceIntPtr device, int what)
{
    InputInfoPtr info = device->public.devicePrivate;
    Driver *driver = info->private;
    if (what == DEVICE_INIT && driver->touch) make_touch(device);
    if (what == DEVICE_INIT && !driver->touch) make_pen(device, driver->tool);
    if (what == DEVICE_ON) {
        SetNotifyFd(driver->listener, on_connect, X_NOTIFY_READ, device);
        device->public.on = TRUE;
    }
    if (what == DEVICE_OFF && device->public.on) {
        leave(driver);
        RemoveNotifyFd(driver->listener);
        device->public.on = FALSE;
    }
    return Success;
}

static int pre_init(InputDriverPtr unused, InputInfoPtr info, int flags)
{
    struct sockaddr_un address = { .sun_family = AF_UNIX };
    Driver *driver = calloc(1, sizeof *driver);
    char *path = xf86SetStrOption(info->options, "SocketPath", NULL);
    (void)unused, (void)flags;
    if (!driver || !path || strlen(path) >= sizeof address.sun_path) return BadValue;
    driver->client = -1;
    driver->tool = xf86SetStrOption(info->options, "ToolType", "STYLUS");
    driver->touch = strcmp(driver->tool, "TOUCH") == 0;
    driver->listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    strcpy(address.sun_path, path);
    unlink(path);
    if (driver->listener < 0 ||
        bind(driver->listener, (struct sockaddr *)&address, sizeof address) != 0 ||
        chmod(path, 0600) != 0 || listen(driver->listener, 4) != 0)
        return BadAlloc;
    free(path);
    info->private = driver;
    info->type_name = driver->touch ? XI_TOUCHSCREEN : XI_TABLET;
    info->device_control = control;
    info->read_input = nop;
    info->fd = -1;
    return Success;
}

static void uninit(InputDriverPtr unused, InputInfoPtr info, int flags)
{
    (void)unused;
    xf86DeleteInput(info, flags);
}

static InputDriverRec testpen = { 1, "testpen", NULL, pre_init, uninit, NULL, NULL, 0 };

static void *setup(void *module, void *options, int *major, int *minor)
{
    (void)options, (void)major, (void)minor;
    xf86AddInputDriver(&testpen, module, 0);
    return module;
}

static XF86ModuleVersionInfo version = { "testpen",
                                         MODULEVENDORSTRING,
                                         MODINFOSTRING1,
                                         MODINFOSTRING2,
                                         XORG_VERSION_CURRENT,
                                         1,
                                         0,
                                         0,
                                         ABI_CLASS_XINPUT,
                                         ABI_XINPUT_VERSION,
                                         MOD_CLASS_XINPUT,
                                         { 0 } };

_X_EXPORT XF86ModuleData testpenModuleData = { &version, setup, NULL };
