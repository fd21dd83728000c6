#include "backends/vulkan/specialized.h"

#include "core/base/error.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <set>

namespace tetrace::vulkan {

namespace {

using Words = std::vector<std::uint32_t>;
using Instruction = std::span<const std::uint32_t>;

/// Numbers of the SPIR-V specification, 3.37 and 3.20.
enum class Op : std::uint32_t {
    type_bool = 20,
    constant_true = 41,
    constant_false = 42,
    constant = 43,
    constant_composite = 44,
    specialized_true = 48,
    specialized_false = 49,
    specialized_constant = 50,
    specialized_composite = 51,
    specialized_operation = 52,
    decorate = 71,
    extract = 81,
    multiply = 132,
    select = 169,
    equal = 170,
    less = 176,
};

constexpr std::uint32_t word_of(Op op)
{
    return static_cast<std::uint32_t>(op);
}

constexpr std::uint32_t specialization_id = 1;
constexpr std::size_t header_words = 5;

/// Reads a module's instructions in order: a constant's decorations come before it, and so does what it is made of.
class Specializer {
public:
    explicit Specializer(std::span<const std::uint32_t> values) : values_(values) {}

    void take(Instruction instruction)
    {
        switch (Op{instruction[0] & 0xFFFFu}) {
        case Op::decorate:
            if (instruction[2] != specialization_id || instruction[3] >= values_.size()) break;
            given_[instruction[1]] = values_[instruction[3]];
            return;
        case Op::type_bool: bools_.insert(instruction[1]); break;
        case Op::constant_true: known_[instruction[2]] = {1}; break;
        case Op::constant_false: known_[instruction[2]] = {0}; break;
        case Op::constant:
            if (instruction.size() == 4) known_[instruction[2]] = {instruction[3]};
            break;
        case Op::specialized_true:
        case Op::specialized_false:
        case Op::specialized_constant:
            if (const auto given = given_.find(instruction[2]); given != given_.end())
                return add_constant(instruction, given->second);
            break;
        case Op::specialized_composite: return add_composite(instruction);
        case Op::specialized_operation:
            if (const auto value = value_of(instruction)) return add_constant(instruction, *value);
            break;
        default: break;
        }
        add(instruction);
    }

    [[nodiscard]] Words take_words() { return std::move(words_); }
    void add(Instruction instruction) { words_.insert(words_.end(), instruction.begin(), instruction.end()); }

private:
    /// In place of an instruction with the same type and ID.
    void add_constant(Instruction instruction, std::uint32_t value)
    {
        if (bools_.contains(instruction[1])) {
            add(Words{3u << 16 | word_of(value != 0 ? Op::constant_true : Op::constant_false), instruction[1],
                      instruction[2]});
            value = value != 0 ? 1 : 0;
        } else {
            add(Words{4u << 16 | word_of(Op::constant), instruction[1], instruction[2], value});
        }
        known_[instruction[2]] = {value};
    }

    void add_composite(Instruction instruction)
    {
        Words all(instruction.begin(), instruction.end()), parts;
        for (const std::uint32_t id : instruction.subspan(3))
            if (const auto part = known_.find(id); part != known_.end() && part->second.size() == 1)
                parts.push_back(part->second.front());
        if (parts.size() == instruction.size() - 3) {
            all[0] = (all[0] & 0xFFFF0000u) | word_of(Op::constant_composite);
            known_[instruction[2]] = parts;
        }
        add(all);
    }

    /// instruction: type, ID, operation, operands. Empty: not known.
    [[nodiscard]] std::optional<std::uint32_t> value_of(Instruction instruction) const
    {
        const std::uint32_t operation = instruction[3];
        const Instruction operands = instruction.subspan(4);
        if (Op{operation} == Op::extract) {
            const auto whole = known_.find(operands[0]);
            if (whole == known_.end() || operands.size() != 2 || operands[1] >= whole->second.size()) return {};
            return whole->second[operands[1]];
        }
        Words in;
        for (const std::uint32_t id : operands) {
            const auto operand = known_.find(id);
            if (operand == known_.end() || operand->second.size() != 1) return {};
            in.push_back(operand->second.front());
        }
        switch (Op{operation}) {
        case Op::multiply: return in[0] * in[1];
        case Op::select: return in[0] != 0 ? in[1] : in[2];
        case Op::equal: return in[0] == in[1] ? 1 : 0;
        case Op::less: return in[0] < in[1] ? 1 : 0;
        default: return {};
        }
    }

    std::span<const std::uint32_t> values_;
    std::map<std::uint32_t, std::uint32_t> given_; ///< of constants, by their ID in the module
    std::map<std::uint32_t, Words> known_;         ///< of all constants of 32 bits, and of vectors of them
    std::set<std::uint32_t> bools_;                ///< the type
    Words words_;
};

} // namespace

std::vector<std::uint32_t> specialized(std::span<const std::byte> module, std::span<const std::uint32_t> values)
{
    Words words(module.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), module.data(), words.size() * sizeof(std::uint32_t));
    Specializer specializer(values);
    const Instruction all(words);
    specializer.add(all.first(std::min(header_words, all.size())));
    for (std::size_t at = header_words, count = 0; at < all.size(); at += count) {
        count = all[at] >> 16;
        if (count == 0 || count > all.size() - at)
            throw Error(ErrorKind::internal, "a SPIR-V module has an instruction without an end");
        specializer.take(all.subspan(at, count));
    }
    return specializer.take_words();
}

} // namespace tetrace::vulkan
