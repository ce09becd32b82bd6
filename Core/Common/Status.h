#pragma once

#include <optional>
#include <string>
#include <utility>

namespace bsr
{
/// Why a Core function did not deliver.
enum class StatusCode
{
  Ok,
  InvalidInput,     ///< the data cannot be processed (empty, NaN, non-manifold, wrong kind)
  InvalidParameter, ///< an option is outside its range
  Cancelled,        ///< the monitor asked to stop; nothing was produced
  Failed            ///< a numerical or topological failure inside the algorithm
};

/**
 * Outcome of a Core function. Core neither prints, exits nor throws across its border.
 * A failure's message is one sentence or two that name the cause and the cure.
 */
class [[nodiscard]] Status
{
public:
  Status() = default;
  Status(StatusCode code, std::string message) : Code(code), Message(std::move(message)) {}

  static Status ok() { return {}; }
  static Status invalidInput(std::string m) { return {StatusCode::InvalidInput, std::move(m)}; }
  static Status invalidParameter(std::string m)
  {
    return {StatusCode::InvalidParameter, std::move(m)};
  }
  static Status cancelled() { return {StatusCode::Cancelled, "Cancelled."}; }
  static Status failed(std::string m) { return {StatusCode::Failed, std::move(m)}; }

  bool isOk() const { return this->Code == StatusCode::Ok; }
  explicit operator bool() const { return this->isOk(); }
  StatusCode code() const { return this->Code; }
  const std::string& message() const { return this->Message; }

private:
  StatusCode Code = StatusCode::Ok;
  std::string Message;
};

/// A value, or the status that says why there is none.
template <class T>
class [[nodiscard]] Result
{
public:
  Result(T value) : Value(std::move(value)) {}      // NOLINT: implicit on purpose
  Result(Status status) : Why(std::move(status)) {} // NOLINT: implicit on purpose

  bool isOk() const { return this->Value.has_value(); }
  explicit operator bool() const { return this->isOk(); }
  const Status& status() const { return this->Why; }
  T& value() { return *this->Value; }
  const T& value() const { return *this->Value; }
  T* operator->() { return &*this->Value; }
  const T* operator->() const { return &*this->Value; }
  T& operator*() { return *this->Value; }
  const T& operator*() const { return *this->Value; }

private:
  std::optional<T> Value;
  Status Why;
};
} // namespace bsr
