#pragma once

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tetrace::spirv {

/// A scalar of a push constant block: its path of member names, its offset in bytes, its type.
struct Member {
    std::string path;
    std::uint32_t offset;
    std::string type; ///< "float", "uint"; "vector" and others are none of ours

    friend bool operator==(const Member&, const Member&) = default;
};

/// A storage buffer whose block has one array.
struct Array {
    std::uint32_t binding, stride;
    bool writable;

    friend bool operator==(const Array&, const Array&) = default;
};

/// A SPIR-V module, as far as the checks read it. Source: SPIR-V Specification 1.6, sections 2.3 and 3.
class Module {
public:
    /// Throws std::runtime_error if the bytes are not a module.
    explicit Module(std::span<const std::byte> bytes) : words_(bytes.size() / 4)
    {
        std::memcpy(words_.data(), bytes.data(), 4 * words_.size());
        if (words_.size() < 5 || words_[0] != spv::MagicNumber) throw std::runtime_error("not SPIR-V");
        for (std::size_t at = 5; at < words_.size(); at += words_[at] >> spv::WordCountShift) {
            const std::size_t count = words_[at] >> spv::WordCountShift;
            if (count == 0 || at + count > words_.size()) throw std::runtime_error("SPIR-V that is cut off");
            read(static_cast<spv::Op>(words_[at] & spv::OpCodeMask), std::span(words_).subspan(at + 1, count - 1));
        }
    }

    /// Operations that round, and so may be contracted with others.
    [[nodiscard]] std::size_t rounding_operations() const { return rounding_.size(); }
    /// Those of them that are not decorated NoContraction, and fused ones.
    [[nodiscard]] std::size_t contractible_operations() const
    {
        std::size_t count = fused_;
        for (const std::uint32_t id : rounding_)
            count += decoration(id, spv::DecorationNoContraction) ? 0 : 1;
        return count;
    }

    /// Storage buffers by the name of their array.
    [[nodiscard]] std::map<std::string, Array> arrays() const
    {
        std::map<std::string, Array> found;
        for (const auto& [id, variable] : variables_) {
            if (variable.storage != spv::StorageClassStorageBuffer) continue;
            const std::uint32_t block = types_.at(variable.type)[2];
            const std::uint32_t array = types_.at(block)[0];
            found[member_names_.at({block, 0})] = {decoration(id, spv::DecorationBinding).value(),
                                                   decoration(array, spv::DecorationArrayStride).value(),
                                                   !member_decoration(block, 0, spv::DecorationNonWritable)};
        }
        return found;
    }

    /// Bindings of texel buffers by their names.
    [[nodiscard]] std::map<std::string, std::uint32_t> texels() const
    {
        std::map<std::string, std::uint32_t> found;
        for (const auto& [id, variable] : variables_)
            if (variable.storage == spv::StorageClassUniformConstant)
                found[names_.at(id)] = decoration(id, spv::DecorationBinding).value();
        return found;
    }

    /// All scalars of the push constants, in order; empty if there are none.
    [[nodiscard]] std::vector<Member> push_constants() const
    {
        std::vector<Member> members;
        for (const auto& [id, variable] : variables_)
            if (variable.storage == spv::StorageClassPushConstant) flatten(types_.at(variable.type)[2], "", 0, members);
        return members;
    }

    [[nodiscard]] bool has_specialization_constant(std::uint32_t number) const
    {
        for (const auto& [key, value] : decorations_)
            if (key.second == spv::DecorationSpecId && value == number) return true;
        return false;
    }

    /// Instructions whose value a specialization constant decides, and such constants.
    [[nodiscard]] std::size_t specialized_instructions() const { return specialized_; }

private:
    struct Variable {
        std::uint32_t type;
        spv::StorageClass storage;
    };
    using Words = std::span<const std::uint32_t>;

    void read(spv::Op op, Words words)
    {
        switch (op) {
        case spv::OpFAdd:
        case spv::OpFSub:
        case spv::OpFMul:
        case spv::OpFDiv:
        case spv::OpFRem:
        case spv::OpFMod:
        case spv::OpDot:
        case spv::OpVectorTimesScalar:
        case spv::OpMatrixTimesScalar:
        case spv::OpVectorTimesMatrix:
        case spv::OpMatrixTimesVector:
        case spv::OpMatrixTimesMatrix:
        case spv::OpOuterProduct: rounding_.push_back(words[1]); break; // OpFNegate does not round
        case spv::OpExtInst: fused_ += words[3] == GLSLstd450Fma ? 1 : 0; break;
        case spv::OpSpecConstantTrue:
        case spv::OpSpecConstantFalse:
        case spv::OpSpecConstant:
        case spv::OpSpecConstantComposite:
        case spv::OpSpecConstantOp: ++specialized_; break;
        case spv::OpDecorate: decorations_[{words[0], words[1]}] = words.size() > 2 ? words[2] : 0; break;
        case spv::OpMemberDecorate:
            member_decorations_[{{words[0], words[1]}, words[2]}] = words.size() > 3 ? words[3] : 0;
            break;
        case spv::OpName: names_[words[0]] = reinterpret_cast<const char*>(words.subspan(1).data()); break;
        case spv::OpMemberName:
            member_names_[{words[0], words[1]}] = reinterpret_cast<const char*>(words.subspan(2).data());
            break;
        case spv::OpVariable: variables_[words[1]] = {words[0], static_cast<spv::StorageClass>(words[2])}; break;
        case spv::OpTypePointer: types_[words[0]] = {op, words[1], words[2]}; break;
        case spv::OpTypeStruct:
            types_[words[0]].assign(words.begin() + 1, words.end());
            structs_[words[0]] = true;
            break;
        case spv::OpTypeFloat: scalar_names_[words[0]] = "float"; break;
        case spv::OpTypeInt: scalar_names_[words[0]] = words[2] == 0 ? "uint" : "int"; break;
        case spv::OpTypeVector: scalar_names_[words[0]] = "vector"; break;
        default: break;
        }
    }

    [[nodiscard]] std::optional<std::uint32_t> decoration(std::uint32_t id, std::uint32_t which) const
    {
        const auto found = decorations_.find({id, which});
        return found == decorations_.end() ? std::nullopt : std::optional(found->second);
    }
    [[nodiscard]] std::optional<std::uint32_t> member_decoration(std::uint32_t type, std::uint32_t member,
                                                                 std::uint32_t which) const
    {
        const auto found = member_decorations_.find({{type, member}, which});
        return found == member_decorations_.end() ? std::nullopt : std::optional(found->second);
    }

    void flatten(std::uint32_t type, const std::string& path, std::uint32_t offset, std::vector<Member>& members) const
    {
        if (!structs_.contains(type)) {
            const auto name = scalar_names_.find(type);
            members.push_back({path, offset, name == scalar_names_.end() ? "other" : name->second});
            return;
        }
        const auto& parts = types_.at(type);
        for (std::uint32_t i = 0; i < parts.size(); ++i)
            flatten(parts[i], path + (path.empty() ? "" : ".") + member_names_.at({type, i}),
                    offset + member_decoration(type, i, spv::DecorationOffset).value(), members);
    }

    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<std::uint32_t> words_;
    std::vector<std::uint32_t> rounding_;
    std::size_t fused_ = 0, specialized_ = 0;
    std::map<Pair, std::uint32_t> decorations_; ///< {id, decoration}: its first operand
    std::map<std::pair<Pair, std::uint32_t>, std::uint32_t> member_decorations_; ///< {{type, member}, decoration}
    std::map<std::uint32_t, std::string> names_;
    std::map<Pair, std::string> member_names_;
    std::map<std::uint32_t, Variable> variables_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> types_; ///< operands of pointers (op first) and structs
    std::map<std::uint32_t, bool> structs_;
    std::map<std::uint32_t, std::string> scalar_names_;
};

} // namespace tetrace::spirv
