// SPDX-License-Identifier: MIT
#include "light_sections.hpp"

#include "density_field.hpp"
#include "mips.hpp"
#include "sky_visibility.hpp"
#include "sun_depth.hpp"

namespace bake
{

light_sizes sizes_of(const light_request &want, ijk cells, uint64_t bricks)
{
    light_sizes sizes;

    if (want.mips)
        sizes.mips = mip_bytes(cells, bricks);
    if (want.sun_spacing > 0)
        sizes.sun = sun_cache_bytes(cells, want.sun_spacing);
    if (want.sky_extinction > 0)
        sizes.sky = sky_visibility_bytes(cells);
    return sizes;
}

light_sections make_light_sections(const light_request &want,
                                   const double world[12], const layout &l,
                                   const brick_pool &p, progress &bar)
{
    light_sections out;

    if (want.mips)
        out.mips = make_mips(l, p);
    if (want.sun_spacing == 0 && want.sky_extinction == 0)
        return out;
    const density_field field(l, p);
    if (want.sun_spacing > 0)
        out.sun = make_sun_cache(field, l.cells, want.sun_spacing,
                                 sun_direction(want.sun, world), bar);
    if (want.sky_extinction > 0)
        out.sky = make_sky_visibility(field, l.cells, want.sky_extinction, bar);
    return out;
}

} // namespace bake
