#pragma once

namespace bsr
{
/**
 * Progress and cancellation of a long computation.
 * Functions of Core call `progress` with a share in 0..1 and ask `cancelled` at least every
 * 0.2 s of work; both are called from the calling thread only unless a function says otherwise.
 * The base class ignores progress and never cancels.
 */
class Monitor
{
public:
  Monitor() = default;
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  virtual ~Monitor() = default;
  virtual void progress(double /*share*/) {}
  virtual bool cancelled() { return false; }
};

/// Maps the 0..1 of a part of a computation to [from, to] of the whole.
class SubMonitor : public Monitor
{
public:
  SubMonitor(Monitor& parent, double from, double to) : Parent(parent), From(from), To(to) {}
  void progress(double share) override
  {
    this->Parent.progress(this->From + share * (this->To - this->From));
  }
  bool cancelled() override { return this->Parent.cancelled(); }

private:
  Monitor& Parent;
  double From;
  double To;
};

/// Passes cancellation on, but no progress: for steps that are repeated an unknown number of times.
class QuietMonitor : public Monitor
{
public:
  explicit QuietMonitor(Monitor& parent) : Parent(parent) {}
  bool cancelled() override { return this->Parent.cancelled(); }

private:
  Monitor& Parent;
};
} // namespace bsr
