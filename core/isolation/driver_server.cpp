#include "core/isolation/driver_server.h"

#include "core/device/defects.h"
#include "core/isolation/channel.h"
#include "core/isolation/messages.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <sys/prctl.h>
#include <unistd.h>

namespace tetrace {

namespace {

/// Its files above the socket are those of the process that started it, which may be waited for elsewhere.
void close_inherited_files()
{
    ::close_range(served_socket + 1, ~0u, 0);
}

class Server {
public:
    explicit Server(Backend& backend) : backend_(&backend) {}

    /// The answer to a request.
    [[nodiscard]] ByteWriter answer(Message message)
    {
        ByteWriter answer;
        put_success(answer);
        try {
            ByteReader request(std::move(message.bytes));
            const auto what = request.get<Request>();
            if (what < Request::open)
                answer_backend(answer, what, request, std::move(message.file));
            else if (what == Request::open)
                open(answer, request, std::move(message.file));
            else
                answer_session(answer, what, request, std::move(message.file));
        } catch (...) {
            answer = ByteWriter();
            put_exception(answer);
        }
        return answer;
    }

private:
    struct Opened {
        std::shared_ptr<const SentScene> scene; ///< outlives the session
        std::unique_ptr<Session> session;
    };

    void answer_backend(ByteWriter& answer, Request what, ByteReader& request, Descriptor file)
    {
        if (what == Request::devices) return put_devices(answer, backend_->devices());
        const auto device = request.get<std::uint64_t>();
        if (what == Request::why_not) {
            answer.put_text(backend_->why_not(device, request.get<KernelId>()));
        } else if (what == Request::probe) {
            const auto math = request.get<MathMode>();
            const auto words = backend_->probe(device, math, request.get_all<Quad>());
            answer.put_all(std::span<const std::uint32_t>(words));
        } else if (what == Request::run_defect) {
            const auto launch = request.get<DefectLaunch>();
            const std::string name = request.get_text();
            const auto words = backend_->run_defect(device, name, launch);
            const std::size_t count = output_words(name, launch);
            const SharedMemory memory(std::move(file), count * sizeof(words[0]));
            const auto bytes = std::as_bytes(std::span(words).first(std::min(words.size(), count)));
            std::ranges::copy(bytes, memory.bytes().begin());
            answer.put(std::uint64_t{bytes.size()});
        } else if (what == Request::compiled) {
            const auto has_kernel = request.get<bool>();
            const auto kernel = request.get<KernelId>();
            const auto starts_outside = request.get<bool>();
            const std::filesystem::path program_file = request.get_text();
            const auto code = backend_->compiled(device, has_kernel ? std::optional(kernel) : std::nullopt,
                                                 starts_outside, program_file);
            put_code(answer, code, SharedMemory(std::move(file), max_code_bytes));
        } else {
            const auto yardstick = backend_->yardstick(device, get_options(request));
            answer.put(yardstick.has_value());
            answer.put(yardstick.value_or(Yardstick{}));
        }
    }

    void open(ByteWriter& answer, ByteReader& request, Descriptor file)
    {
        const auto device = request.get<std::uint64_t>();
        const auto kernel = request.get<KernelId>();
        const SessionOptions options = get_options(request);
        Opened opened;
        opened.scene = scene(request, std::move(file));
        opened.session =
            backend_->open(device, kernel, opened.scene != nullptr ? opened.scene->data() : SceneData{}, options);
        answer.put(++last_);
        put_facts(answer, *opened.session);
        sessions_[last_] = std::move(opened);
    }

    /// Sessions of the same scene share it, so that it is here once.
    [[nodiscard]] std::shared_ptr<const SentScene> scene(ByteReader& request, Descriptor file)
    {
        const auto number = request.get<std::uint64_t>();
        const auto is_new = request.get<bool>();
        if (number == 0) return nullptr;
        std::erase_if(scenes_, [](const auto& known) { return known.second.expired(); });
        if (is_new) {
            auto sent = std::make_shared<const SentScene>(get_scene(request, std::move(file)));
            scenes_[number] = sent;
            return sent;
        }
        return scenes_.at(number).lock();
    }

    void answer_session(ByteWriter& answer, Request what, ByteReader& request, Descriptor file)
    {
        const auto number = request.get<std::uint64_t>();
        if (what == Request::close) {
            sessions_.erase(number);
            answer.put(SessionFacts{});
            return;
        }
        Session& session = *sessions_.at(number).session;
        double seconds = 0;
        switch (what) {
        case Request::set_rays: session.set_rays(get_quads(request, std::move(file)).quads()); break;
        case Request::launch: session.launch(request.get_all<TraceJob>()); break;
        case Request::wait: seconds = session.wait(); break;
        default: read(session, what, request.get<std::uint64_t>(), std::move(file)); seconds = session.download_s();
        }
        put_facts(answer, session);
        answer.put(seconds);
    }

    struct SentQuads {
        SharedMemory memory;
        [[nodiscard]] std::span<const Quad> quads() const
        {
            return {reinterpret_cast<const Quad*>(memory.bytes().data()), memory.bytes().size() / sizeof(Quad)};
        }
    };
    [[nodiscard]] static SentQuads get_quads(ByteReader& request, Descriptor file)
    {
        return {SharedMemory(std::move(file), request.get<std::uint64_t>() * sizeof(Quad))};
    }

    static void read(Session& session, Request what, std::uint64_t count, Descriptor file)
    {
        const bool are_faces = what == Request::read_faces;
        const std::size_t bytes = count * (are_faces ? sizeof(std::uint32_t) : sizeof(Hit));
        const SharedMemory memory(std::move(file), bytes + session.tally_words().size_bytes());
        if (are_faces)
            session.read_back(std::span(reinterpret_cast<std::uint32_t*>(memory.bytes().data()), count));
        else
            session.read_back(std::span(reinterpret_cast<Hit*>(memory.bytes().data()), count));
        std::ranges::copy(std::as_bytes(session.tally_words()), memory.bytes().subspan(bytes).begin());
    }

    static void put_facts(ByteWriter& answer, const Session& session)
    {
        answer.put(SessionFacts{session.setup_times(), session.bytes()});
    }

    Backend* backend_;
    std::map<std::uint64_t, Opened> sessions_;
    std::uint64_t last_ = 0;
    std::map<std::uint64_t, std::weak_ptr<const SentScene>> scenes_;
};

} // namespace

int serve_driver(const std::vector<std::string>& arguments, const std::vector<Backend*>& backends)
{
    if (arguments.size() != 2) return exit_code(ErrorKind::usage);
    Backend* const backend = find_backend(arguments[0], backends);
    if (backend == nullptr) return exit_code(ErrorKind::usage);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL); // a driver that hangs would not see the socket close
    if (std::to_string(::getppid()) != arguments[1]) return exit_code(ErrorKind::interrupted);
    close_inherited_files();
    // Where memory is short, the kernel ends this process rather than the one that asks: only its row is lost.
    if (std::ofstream score("/proc/self/oom_score_adj"); score) score << 1000;
    const Channel channel{Descriptor(served_socket)};
    Server server(*backend);
    while (auto message = channel.receive())
        if (!channel.send(server.answer(std::move(*message)).bytes())) break;
    return 0;
}

} // namespace tetrace
