#include "function.h"

#include <pybind11/eval.h>

namespace lightband_python {

namespace {

// The parts of text between separators.
std::vector<std::string> split(const std::string& text, const std::string& separator) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(separator, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + separator.size();
    }
    return parts;
}

}  // namespace

Signature::Signature(const std::string& owner, const char* text) : text_(text) {
    const size_t open = text_.find('(');
    name_ = text_.substr(0, open);
    called_ = name_ == "__init__" ? owner : owner.empty() ? name_ : owner + "." + name_;
    for (const std::string& part : split(text_.substr(open + 1, text_.size() - open - 2), ", ")) {
        const size_t equals = part.find('=');
        if (part.rfind("**", 0) == 0) {
            rest_ = part.substr(2);
        } else if (equals == std::string::npos) {
            parameters_.push_back({part, {}});
        } else {
            parameters_.push_back({part.substr(0, equals), py::eval(part.substr(equals + 1))});
        }
    }
}

// "eye, target, up": what a caller writes.
std::string Signature::listed() const {
    std::string list;
    for (const Parameter& parameter : parameters_) {
        if (parameter.name != "self") {
            list += (list.empty() ? "" : ", ") + parameter.name;
        }
    }
    return list.empty() ? "none" : list;
}

size_t Signature::position_of(const std::string& name) const {
    size_t position = 0;
    while (position < parameters_.size() && parameters_[position].name != name) {
        ++position;
    }
    return position;
}

std::vector<Given> Signature::assign(const py::args& positional, const py::kwargs& named) const {
    std::vector<py::object> values(parameters_.size());
    if (positional.size() > parameters_.size()) {
        const size_t self = !parameters_.empty() && parameters_[0].name == "self" ? 1 : 0;
        throw WrongType(called_ + ": " + std::to_string(positional.size() - self) +
                        " arguments given; its parameters are: " + listed());
    }
    for (size_t i = 0; i < positional.size(); ++i) {
        values[i] = positional[i];
    }
    py::dict rest;
    for (const auto& [key, value] : named) {
        const std::string name = py::cast<std::string>(py::str(key));
        const size_t position = position_of(name);
        if (position < parameters_.size()) {
            if (values[position]) {
                throw WrongType(called_ + ": " + name + " is given twice, by position and by name");
            }
            values[position] = py::reinterpret_borrow<py::object>(value);
        } else if (!rest_.empty()) {
            rest[key] = value;
        } else {
            throw WrongType(called_ + ": there is no parameter " + name + "; its parameters are: " + listed());
        }
    }
    std::vector<Given> given;
    for (size_t i = 0; i < parameters_.size(); ++i) {
        const Parameter& parameter = parameters_[i];
        if (!values[i] && !parameter.default_value) {
            throw WrongType(called_ + ": " + parameter.name + " is missing; its parameters are: " + listed());
        }
        const bool optional = parameter.default_value && parameter.default_value.is_none();
        given.push_back({called_, parameter.name, values[i] ? values[i] : parameter.default_value, optional});
    }
    if (!rest_.empty()) {
        given.push_back({called_, rest_, rest});
    }
    return given;
}

}  // namespace lightband_python
