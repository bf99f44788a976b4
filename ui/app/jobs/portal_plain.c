/* Build without libdbus: there is no portal. */
#include "ui/app/jobs/portal.h"

bool wr_portal_may_be(void)
{
    return false;
}

WrPortalEnd wr_portal_request(const WrPortalRequest *ask, const volatile int *stop, char *path,
                              size_t size)
{
    (void)ask, (void)stop, (void)path, (void)size;
    return WR_PORTAL_NONE;
}
