// SPDX-License-Identifier: MIT
//
// What the checks of an asset find, and the part of them that is about light.
#ifndef BRUME_REFERENCE_FINDINGS_HPP
#define BRUME_REFERENCE_FINDINGS_HPP

#include <map>
#include <string>
#include <vector>

#include "float_dump.hpp"
#include "spec_reader.hpp"

namespace reference
{

class findings
{
  public:
    void add(const std::string &kind, const std::string &what)
    {
        if (++count_[kind] <= listed)
            lines_.push_back(kind + ": " + what);
    }

    std::vector<std::string> lines() const
    {
        std::vector<std::string> all = lines_;
        for (const auto &[kind, count] : count_)
            if (count > listed)
                all.push_back(kind + ": " + std::to_string(count - listed) +
                              " more");
        return all;
    }

  private:
    static constexpr int listed = 8;
    std::vector<std::string> lines_;
    std::map<std::string, int> count_;
};

// MIPS, SUNC and AMBI against the voxels. Every mean; of points and cells, for
// each of which rays are followed in small steps, some from all over.
void check_light(const asset &a, findings &found);

// spec_check_emission.cpp: does the emission of a cell, or its apron, have a
// code that is not 0? The section EMIT as the converter writes it; and of the
// values that a dump has.
bool glows(const asset &a, const ijk &cell);
void check_emission(const asset &a, findings &found);
void check_emission_against(const asset &a, const float_dump &dump,
                            findings &found);

} // namespace reference

#endif
